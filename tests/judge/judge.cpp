// The judge's batch: one file per question in a temporary folder, one list of commands, one
// process.
#include "tests/judge/judge.h"

#include <unistd.h>

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace intaglio::judge {

namespace fs = std::filesystem;

namespace {

// A folder of its own below the system's temporary one, removed with everything in it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (fs::temp_directory_path() / "intaglio-judge-XXXXXX").string();
        if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

bool write(const fs::path& path, std::string_view content) {
    std::ofstream file(path, std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    return file.good();
}

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    return content.str();
}

std::vector<std::uint32_t> words_of(const std::string& bytes) {
    std::vector<std::uint32_t> words(bytes.size() / 4);
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
}

std::string in_quotes(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace

std::optional<fs::path> find(std::string* why) {
    std::error_code ignored;
    const auto is_there = [&](const fs::path& path) { return fs::is_regular_file(path, ignored); };
    if (const char* named = std::getenv("INTAGLIO_JUDGE"); named != nullptr && *named != 0) {
        if (is_there(named)) return fs::path(named);
        if (why != nullptr) *why = fmt::format("INTAGLIO_JUDGE names {}, which is no file", named);
        return std::nullopt;
    }
    if (const char* home = std::getenv("HOME"); home != nullptr) {
        for (const char* folder : {"intaglio-judge", "d3d-judge"}) {
            const fs::path path = fs::path(home) / ".cache" / folder / "judge";
            if (is_there(path)) return path;
        }
    }
    if (why != nullptr) {
        *why =
            "no Direct3D judge in ~/.cache/intaglio-judge, and INTAGLIO_JUDGE is not set; "
            "scripts/judge installs one";
    }
    return std::nullopt;
}

std::string error_code(const Answer& answer) {
    const std::string& text = answer.text;
    for (std::size_t at = text.find("error X"); at != std::string::npos;
         at = text.find("error X", at + 1)) {
        const std::size_t begin = at + 6;
        std::size_t end = begin + 1;
        while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
        if (end > begin + 1) return text.substr(begin, end - begin);
    }
    return {};
}

std::size_t Batch::assemble(std::string text) {
    questions_.push_back({"asm", std::move(text), ""});
    return questions_.size() - 1;
}

std::size_t Batch::disassemble(const std::vector<std::uint32_t>& words) {
    std::string bytes(words.size() * 4, '\0');
    if (!words.empty()) std::memcpy(bytes.data(), words.data(), bytes.size());
    questions_.push_back({"dis", std::move(bytes), ""});
    return questions_.size() - 1;
}

std::size_t Batch::compile(std::string hlsl, std::string entry, std::string profile,
                           Defines defines) {
    std::string arguments = fmt::format(" {} {}", entry, profile);
    for (const auto& [name, value] : defines) arguments += fmt::format(" -D{}={}", name, value);
    questions_.push_back({"hlsl", std::move(hlsl), std::move(arguments)});
    return questions_.size() - 1;
}

Result<std::vector<Answer>> Batch::run(const fs::path& judge) const {
    const TemporaryFolder folder;
    if (folder.path().empty())
        return internal_error("judge", "no temporary folder can be made for the judge");
    std::string list;
    for (std::size_t i = 0; i < questions_.size(); ++i) {
        const Question& question = questions_[i];
        const std::string input = (folder.path() / fmt::format("{}.in", i)).string();
        if (!write(input, question.content))
            return internal_error("judge", "cannot write " + input);
        list += fmt::format("{} {}{}", question.command, input, question.arguments);
        if (question.command != "dis")
            list += fmt::format(" -o {}", (folder.path() / fmt::format("{}.out", i)).string());
        list += '\n';
    }
    const fs::path commands = folder.path() / "list", output = folder.path() / "answers",
                   errors = folder.path() / "errors";
    if (!write(commands, list)) return internal_error("judge", "cannot write " + commands.string());
    // To files, not pipes: Wine's server outlives the judge and would hold a pipe open.
    const std::string command = fmt::format("{} batch {} </dev/null >{} 2>{}",
                                            in_quotes(judge.string()), in_quotes(commands.string()),
                                            in_quotes(output.string()), in_quotes(errors.string()));
    const int status = std::system(command.c_str());
    const std::vector<Verdict> verdicts = cut_verdicts(read(output));
    if (status != 0 || verdicts.size() != questions_.size()) {
        return internal_error(
            "judge", fmt::format("the judge answered {} of {} questions (status {}): {}",
                                 verdicts.size(), questions_.size(), status, read(errors)));
    }
    std::vector<Answer> answers;
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
        if (verdicts[i].exit_code > 1)
            return internal_error("judge", "the judge could not work: " + verdicts[i].text);
        answers.push_back({verdicts[i].exit_code == 0, verdicts[i].text,
                           words_of(read(folder.path() / fmt::format("{}.out", i)))});
    }
    return answers;
}

std::vector<Verdict> cut_verdicts(std::string_view output) {
    std::vector<Verdict> verdicts;
    std::string text;
    while (!output.empty()) {
        const std::size_t end = output.find('\n');
        std::string_view line = output.substr(0, end);
        output = end == std::string_view::npos ? std::string_view() : output.substr(end + 1);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        int code = 0;
        if (line.starts_with("#### ") &&
            std::from_chars(line.data() + 5, line.data() + line.size(), code).ec == std::errc()) {
            verdicts.push_back({code, std::move(text)});
            text.clear();
        } else {
            text.append(line);
            text += '\n';
        }
    }
    return verdicts;
}

}  // namespace intaglio::judge
