// What the command line is, as data: read from the definitions that parse it, so that the manual
// page and the completions say what the program does and nothing else.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/base/result.h"

namespace CLI {
class App;
}

namespace intaglio::cli {

struct OptionText {
    std::vector<std::string> names;  // "-T", "--target"; of a positional: "surface"
    // What stands for its value, and says how to complete it: alternatives ("vertex|pixel"), a file
    // ("FILE", or with an ending "FILE.png"), a folder ("DIR"), or a list of the program's
    // ("SURFACE", "TARGET", "KNOB=NUMBER", "LOOP=FORM", "MAP", "KIND=FILE.png").  Empty: a flag.
    std::string value;
    std::string initial;  // what it is where not given
    std::string text;
    bool positional = false, required = false, repeatable = false;
    bool optional_value = false;  // "--dump-ir" and "--dump-ir=all" are both right
};

struct CommandText {
    std::string name;  // "intaglio", "emit"
    std::string text;
    std::vector<OptionText> options;  // positionals first, each in the order of their definition
    std::vector<CommandText> commands;
};

// Gives the options of `app` and its commands the names of their values, for the help, the manual
// and the completions.
void name_values(CLI::App& app);

CommandText describe(const CLI::App& app);

// `manual` and `completion`, which print what `app` is when they run; `chosen` is set to the work
// of the one that was named.
void add_shells(CLI::App& app, std::function<Status()>& chosen);

}  // namespace intaglio::cli
