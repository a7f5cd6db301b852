// The command line as a function, so that a program with techniques of its own gets every command
// for them: fill a catalogue, call this from main.
#pragma once

#include "generator/dsl/catalogue.h"

namespace intaglio::cli {

// Exit codes of every command.
enum ExitCode {
    exit_fine = 0,
    exit_over_budget = 1,  // a limit was exceeded
    exit_bad_input = 2,    // input or usage: the message says what to change
    exit_own_failure = 3,  // something that should not have happened
};

// Runs one command.  The product goes to stdout or to the file of -o, every message to stderr.
int run_command_line(int argument_count, const char* const* arguments,
                     const dsl::Catalogue& catalogue);

}  // namespace intaglio::cli
