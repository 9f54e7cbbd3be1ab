# Completion of gaitpad in fish: the program itself says what may follow (gaitpad __complete).
function __gaitpad_candidates
    set -l before (commandline -opc)
    set -l prefix (commandline -ct)
    for line in ($before[1] __complete $before[2..-1] $prefix 2>/dev/null)
        switch $line
            case :files
                __fish_complete_path $prefix
            case :folders
                __fish_complete_directories $prefix
            case '*'
                echo $line
        end
    end
end
complete -c gaitpad -f -a '(__gaitpad_candidates)'
