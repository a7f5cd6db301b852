# Completion of @PROGRAM@ in bash: source this, or let bash-completion find it as completions/@PROGRAM@.
# The program itself says what may follow; needs nothing beyond bash 4.
@FUNCTION@() {
    local i word previous="" value what file words=()
    # Bash parts words at "="; here they are whole.
    for ((i = 1; i <= COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        if ((${#words[@]} > 0)) && [[ $COMP_WORDBREAKS == *=* && ($word == =* || $previous == *=) ]]; then
            words[${#words[@]} - 1]+=$word
        else
            words+=("$word")
        fi
        previous=$word
    done
    word=${words[${#words[@]} - 1]}
    # What of the word bash does not replace, and so must not be in a reply.
    local kept=""
    [[ $COMP_WORDBREAKS == *=* && $word == *=* ]] && kept="${word%=*}="

    COMPREPLY=()
    while IFS=$'\t' read -r value what; do
        case $value in
            :files* | :folders) # a file's ending after "=", and in `what` what of the word comes before its name
                compopt -o filenames
                while IFS= read -r file; do
                    file=$what$file
                    COMPREPLY+=("${file#"$kept"}")
                done < <(
                    begun=${word#"$what"}
                    [[ $value == :files ]] || compgen -d -- "$begun"
                    case $value in
                        :files=*) compgen -f -X "!*.${value#*=}" -- "$begun" ;;
                        :files) compgen -f -- "$begun" ;;
                    esac
                )
                ;;
            *)
                COMPREPLY+=("${value#"$kept"}")
                [[ $value == *[=,] ]] && compopt -o nospace
                ;;
        esac
    done < <("${1/#\~/$HOME}" @COMPLETE@ "${words[@]}" 2>/dev/null)
}
complete -F @FUNCTION@ @PROGRAM@
