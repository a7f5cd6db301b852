#compdef @PROGRAM@
# Completion of @PROGRAM@ in zsh: as _@PROGRAM@ in a folder of $fpath, or sourced after compinit.
# The program itself says what may follow.
@FUNCTION@() {
    local value what
    local -a closed open
    while IFS=$'\t' read -r value what; do
        case $value in
            (:files*|:folders) # a file's ending after "=", and in `what` what of the word comes before its name
                compset -P ${(b)what}
                case $value in
                    (:files=*) _files -g "*.${value#*=}(-.)" ;;
                    (:files) _files ;;
                    (:folders) _files -/ ;;
                esac
                ;;
            # More of the word follows: no space after it.
            (*[=,]) open+=("${value//:/\\:}:$what") ;;
            (*) closed+=("${value//:/\\:}:$what") ;;
        esac
    done < <(${(Q)words[1]/#\~/$HOME} @COMPLETE@ "${(@Q)words[2,CURRENT-1]}" "$PREFIX" 2>/dev/null)
    (( $#open )) && _describe -t values value open -S ''
    (( $#closed )) && _describe -t values value closed
}
if [ "$funcstack[1]" = "_@PROGRAM@" ]; then
    @FUNCTION@ "$@"
else
    compdef @FUNCTION@ @PROGRAM@
fi
