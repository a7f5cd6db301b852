// The names of the options' values are one table: who adds an option to a command need not know it,
// and gets what CLI11 says of the type ("TEXT") until there is a row.
#include "src/cli/description.h"

#include <algorithm>
#include <string_view>

#include <CLI/CLI.hpp>

#include "src/cli/commands.h"
#include "src/cli/completion.h"
#include "src/cli/manual.h"

namespace intaglio::cli {
namespace {

struct Row {
    std::string_view command;  // empty: every one without a row of its own
    std::string_view option;   // long name, or a positional's
    const char* value;
};

constexpr const char* size_name = "WIDTHxHEIGHT";

constexpr Row rows[] = {
    {"list", "what", "techniques|targets|knobs|maps"},
    {"", "surface", "SURFACE"},
    {"", "surfaces", "SURFACE"},
    {"", "target", "TARGET"},
    {"", "targets", "TARGET"},
    {"", "define", "KNOB=NUMBER"},
    {"", "loop", "LOOP=FORM"},
    {"", "split", "shading|shadow|sections=N"},
    {"", "pass", "N"},
    {"", "stage", "vertex|pixel"},
    {"", "as", "shader|function|bytecode"},
    {"", "part", "search|shadow"},
    {"", "bind", "parameters|globals"},
    {"", "dump-ir", "all|final|PASS"},
    {"", "maker", "MAP"},
    {"", "height", "FILE.png"},
    {"", "normal", "FILE.png"},
    {"", "colour", "FILE.png"},
    {"", "baked", "KIND=FILE.png"},
    {"", "input", "FILE.png"},
    {"", "map-size", size_name},
    {"", "filtering", "float|native"},
    {"", "device", "DEVICE"},
    {"", "chip", "CHIP"},
    {"", "mesh", "map|quad|sphere|torus"},
    {"", "geometry", "polygon|displaced|shells"},
    {"", "arithmetic", "fp32|fp24|fp16"},
    {"", "pixel", "X,Y"},
    {"", "error-map", "FILE.png"},
    {"run", "size", size_name},
    {"run", "format", "rgba8|rgba16|rgba16f|rgba32f"},
    {"", "kernel", "central|sobel"},
    {"", "wrap", "repeat|clamp"},
    {"", "scene", "FILE.toml"},
    {"", "sweep", "FILE.toml"},
    {"", "budgets", "FILE.toml"},
    {"", "baseline", "FILE.jsonl"},
    {"", "before", "FILE.jsonl"},
    {"", "after", "FILE.jsonl"},
    {"check", "format", "text|json|junit|github|sarif"},
    {"diff", "format", "text|json|junit|github|sarif"},
    {"", "today", "DATE"},
    {"", "shard", "PART/PARTS"},
    {"", "only", "NAME"},
    {"", "folder", "DIR"},
    {"", "folders", "DIR"},
    {"", "maps", "DIR"},
    {"", "cache", "DIR"},
    {"", "namespace", "NAME"},
    {"", "markdown", "FILE.md"},
    {"build", "output", "DIR"},
    {"build", "surface", "NAME"},
    {"", "depfile-name", "FILE.d"},
    {"", "depfile-target", "NAME"},
    {"", "expect", "FILE"},
    {"", "ninja", "FILE.ninja"},
    {"", "order", "FILE.json"},
    {"", "step", "orders|maps|header|manifest"},
    {"cache", "size", "BYTES"},
    {"measure", "output", "DIR"},
    {"merge", "output", "DIR"},
    {"pages", "output", "DIR"},
    {"sheet", "output", "DIR"},
    {"sweep", "output", "DIR"},
    {"bake", "output", "FILE.png"},
    {"run", "output", "FILE.png"},
    {"report", "output", "FILE.html"},
    {"", "output", "FILE"},
    {"", "shell", "bash|zsh"},
    {"", "program", "NAME"},
};

const char* value_name(std::string_view command, std::string_view option) {
    const char* common = nullptr;
    for (const Row& row : rows) {
        if (row.option != option) continue;
        if (row.command == command) return row.value;
        if (row.command.empty()) common = row.value;
    }
    return common;
}

void name_values_of(CLI::App& app, std::string_view command) {
    for (CLI::Option* option : app.get_options({})) {
        const bool long_name = !option->get_lnames().empty();
        const std::string name = long_name ? option->get_lnames().front() : option->get_name(true);
        const char* value = value_name(command, name);
        if (value && option->get_items_expected_max() > 0) option->type_name(value);
    }
    for (CLI::App* inner : app.get_subcommands({}))
        name_values_of(*inner, command.empty() ? std::string_view(inner->get_name()) : command);
}

OptionText describe_option(const CLI::Option& option) {
    OptionText text;
    text.positional = option.get_positional();
    if (text.positional) {
        text.names.push_back(option.get_name(true));
    } else {
        for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
    }
    text.text = option.get_description();
    text.required = option.get_required();
    if (option.get_items_expected_max() == 0) return text;
    text.repeatable = option.get_expected_max() == CLI::detail::expected_max_vector_size;
    text.optional_value = option.get_expected_min() == 0;
    text.value = option.get_type_name();
    // A validator describes itself as "INT:{8,16}" or "INT:INT in [1 - 256]".
    if (const std::size_t set = text.value.find(":{"); set != std::string::npos) {
        text.value = text.value.substr(set + 2, text.value.size() - set - 3);
        std::replace(text.value.begin(), text.value.end(), ',', '|');
    } else if (const std::size_t range = text.value.find(':'); range != std::string::npos) {
        text.value.resize(range);
    }
    if (!text.optional_value && option.get_default_str() != "[]")
        text.initial = option.get_default_str();
    return text;
}

}  // namespace

void name_values(CLI::App& app) { name_values_of(app, {}); }

CommandText describe(const CLI::App& app) {
    CommandText command{app.get_name(), app.get_description(), {}, {}};
    for (const bool positional : {true, false})
        for (const CLI::Option* option : app.get_options({}))
            if (!option->get_group().empty() && option->get_positional() == positional)
                command.options.push_back(describe_option(*option));
    for (const CLI::App* inner : app.get_subcommands({}))
        if (!inner->get_group().empty()) command.commands.push_back(describe(*inner));
    return command;
}

void add_shells(CLI::App& app, std::function<Status()>& chosen) {
    struct Options {
        std::string shell, program, output = "-";
    };
    auto options = std::make_shared<Options>();
    CLI::App* manual = app.add_subcommand("manual", "The manual page, for man");
    CLI::App* completion = app.add_subcommand(
        "completion", "The script with which a shell completes words of this program");
    completion->add_option("shell", options->shell, "bash or zsh")->required();
    completion->add_option("--program", options->program, "Of another name than this one");
    for (CLI::App* command : {manual, completion})
        command->add_option("-o,--output", options->output, "File; - is stdout")
            ->capture_default_str();
    manual->callback([&app, &chosen, options] {
        chosen = [&app, options] {
            return write_product(options->output, manual_page(describe(app), version()), false);
        };
    });
    completion->callback([&app, &chosen, options] {
        chosen = [&app, options]() -> Status {
            const Result<std::string> script = completion_script(
                options->shell, options->program.empty() ? app.get_name() : options->program);
            return script ? write_product(options->output, *script, false) : script.error();
        };
    });
}

}  // namespace intaglio::cli
