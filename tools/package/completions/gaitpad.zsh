#compdef gaitpad
# Completion of gaitpad in zsh: the program itself says what may follow (gaitpad __complete).
_gaitpad() {
  local line word
  local -a candidates
  for line in "${(@f)$("${words[1]}" __complete "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    case $line in
      :files) _files ;;
      :folders) _files -/ ;;
      ?*)
        word=${${line%%$'\t'*}//:/\\:}
        candidates+=("$word:${line#*$'\t'}")
        ;;
    esac
  done
  _describe gaitpad candidates
}
_gaitpad "$@"
