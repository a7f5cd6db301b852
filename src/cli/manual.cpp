// man(7): a request begins with a dot at the start of a line, an escape with a backslash anywhere.
#include "src/cli/manual.h"

#include <fmt/format.h>

namespace intaglio::cli {
namespace {

// Text that roff shows as it is.
std::string plain(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else if (c == '`' || c == '\'')
            escaped += "\\(aq";
        else
            escaped += c == '\n' ? ' ' : c;
    }
    return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

std::string head_of(const OptionText& option) {
    if (option.positional) return italic(option.names.front());
    std::string head;
    for (const std::string& name : option.names) head += (head.empty() ? "" : ", ") + bold(name);
    if (option.value.empty()) return head;
    return head +
           (option.optional_value ? "[=" + italic(option.value) + "]" : " " + italic(option.value));
}

std::string lines_of(const OptionText& option) {
    std::string text = plain(option.text);
    // Alternatives are in the text.
    if (option.positional && option.value.find('|') == std::string::npos)
        text += fmt::format(" ({})", italic(option.value));
    if (!option.initial.empty()) text += fmt::format(" (default {})", bold(option.initial));
    return fmt::format(".TP\n{}\n{}\n", head_of(option), text);
}

// What must be said, and that there is more.
std::string synopsis(const std::string& name, const CommandText& command) {
    std::string line = bold(name);
    for (const OptionText& option : command.options) {
        if (option.positional) {
            const std::string shown =
                italic(option.names.front()) + (option.repeatable ? " ..." : "");
            line += option.required ? " " + shown : " [" + shown + "]";
        } else if (option.required) {
            line += " " + bold(option.names.front()) + " " + italic(option.value);
        }
    }
    return line + (command.commands.empty() ? " [options]" : " " + italic("command"));
}

void add_command(std::string& page, const std::string& before, const CommandText& command) {
    const std::string name = before + " " + command.name;
    page += fmt::format(".SS {}\n{}.\n.PP\n{}\n", plain(name), plain(command.text),
                        synopsis(name, command));
    for (const OptionText& option : command.options)
        if (option.names.back() != "--help") page += lines_of(option);
    for (const CommandText& inner : command.commands) add_command(page, name, inner);
}

std::string example(const std::string& what, const std::string& command) {
    return fmt::format(".TP\n{}:\n.EX\n{}\n.EE\n", plain(what), plain(command));
}

constexpr const char* description =
    R"(.SH DESCRIPTION
A technique for relief surfaces (bump mapping, parallax occlusion, steep parallax, self-shadow, fur) is written once;
this program emits it for every shader model from ps_2_0 to Vulkan, has each variant judged, draws it, and says what it
costs and how wrong it is.
.PP
A surface is a preset, a search, or a composition as
.BR search=steep_parallax,shadow=march .
What techniques, targets, knobs and maps there are,
.B list
says.
)";

constexpr const char* exit_status =
    R"(.SH EXIT STATUS
.TP
0
Fine.
.TP
1
A limit was exceeded
.RB ( check ).
.TP
2
Bad input or usage; the message says what to change.
.TP
3
A failure of the program itself.
.PP
What is made goes to standard output or to the file of
.BR \-o ,
which is written whole or not at all; messages go to standard error, as
.IR file:line:col :
error:
.I sentence
.RI [ code ].
)";

}  // namespace

std::string manual_page(const CommandText& program, const std::string& version) {
    const std::string& name = program.name;
    std::string title = plain(name), sentence = program.text;
    for (char& c : title)
        if (c >= 'a' && c <= 'z') c += 'A' - 'a';
    if (sentence.ends_with('.')) sentence.pop_back();
    std::string page = fmt::format(
        ".\\\" Made by `{0} manual`.\n.TH \"{1}\" 1 \"\" \"{0} {2}\"\n.SH NAME\n{8} \\- {3}\n"
        ".SH SYNOPSIS\n{4} {5} [options]\n.br\n{4} {5} {6}\n.br\n{4} {7}\n",
        name, title, plain(version), plain(sentence), bold(name), italic("command"), bold("--help"),
        bold("--version"), plain(name));
    page += description;
    page += ".SH COMMANDS\n";
    for (const CommandText& command : program.commands) add_command(page, name, command);
    page += exit_status;
    page += ".SH EXAMPLES\n";
    page += example("What there is", name + " list techniques");
    page += example("One variant, to read or to paste",
                    name + " emit parallax_occlusion -T glsl_450 -D taps=12");
    page += example("Who spends its slots", name + " explain parallax_occlusion -T ps_2_b");
    page += example("A picture", name +
                                     " run steep_parallax,shadow=march -T glsl_450 "
                                     "--maker bricks -o bricks.png");
    return page;
}

}  // namespace intaglio::cli
