# Completion of gaitpad in bash: the program itself says what may follow (gaitpad __complete).
_gaitpad() {
  local line kind prefix=${COMP_WORDS[COMP_CWORD]}
  [ "$prefix" = "=" ] && prefix=
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      :files | :folders)
        kind=-f
        [ "$line" = :folders ] && kind=-d
        compopt -o filenames 2>/dev/null
        while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen "$kind" -- "$prefix")
        ;;
      *) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done < <("${COMP_WORDS[0]}" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _gaitpad gaitpad
