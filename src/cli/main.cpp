// The `intaglio` program: the command line over Intaglio's own techniques.
#include "src/cli/command_line.h"
#include "templates/all_techniques.h"

int main(int argument_count, char** arguments) {
    return intaglio::cli::run_command_line(argument_count, arguments,
                                           intaglio::templates::all_techniques());
}
