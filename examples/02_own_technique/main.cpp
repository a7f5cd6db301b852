// Intaglio's command line with one technique more: every target, check, picture and measurement
// works for it.
#include "bisection.h"
#include "src/cli/command_line.h"
#include "templates/all_techniques.h"

int main(int argument_count, char** arguments) {
    intaglio::dsl::Catalogue catalogue = intaglio::templates::all_techniques();
    catalogue.searches.push_back(bisection());
    return intaglio::cli::run_command_line(argument_count, arguments, catalogue);
}
