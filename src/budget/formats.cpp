// The five forms and the patch.
#include "src/budget/formats.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "src/measure/named_metric.h"

namespace intaglio::budget {
namespace {

using Json = nlohmann::ordered_json;

std::string_view word_of(Finding::Kind kind) {
    switch (kind) {
        case Finding::Kind::Fine: return "fine";
        case Finding::Kind::Over: return "over";
        case Finding::Kind::Waived: return "waived";
        case Finding::Kind::Unknown: return "unknown";
        case Finding::Kind::Vanished: return "vanished";
    }
    return "fine";
}

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:g}", *value) : "-";
}

std::string percent(double growth) {
    return std::isinf(growth) ? "from 0" : fmt::format("{:+.1f} %", 100 * (growth - 1));
}

std::string change_line(const Finding& finding) {
    return fmt::format("  {:<44} {:<14} {:>10} -> {:>10}  {:>9}\n", finding.name(), finding.metric,
                       number(finding.before), number(finding.after), percent(*finding.growth()));
}

// Those that changed in one direction, the greatest change first.
std::vector<const Finding*> changes(const Verdict& verdict, bool worse) {
    std::vector<const Finding*> found;
    for (const Finding& finding : verdict.findings)
        if (const auto growth = finding.growth(); growth && (*growth > 1) == worse)
            found.push_back(&finding);
    std::stable_sort(found.begin(), found.end(), [&](const Finding* a, const Finding* b) {
        return worse ? *a->growth() > *b->growth() : *a->growth() < *b->growth();
    });
    return found;
}

std::string failure_text(const Finding& finding) {
    std::string text =
        fmt::format("{}: {}: {}\n", word_of(finding.kind), finding.name(), finding.sentence);
    if (!finding.where.empty()) text += fmt::format("  spent by {}\n", finding.where);
    if (!finding.command.empty()) text += fmt::format("  see it: {}\n", finding.command);
    return text;
}

std::string changes_text(const char* title, const std::vector<const Finding*>& found) {
    if (found.empty()) return {};
    std::string text = fmt::format("\n{}:\n", title);
    for (const Finding* finding : found) text += change_line(*finding);
    return text;
}

// By metric: how many variants it helped and hurt, and the sum before and after where it is one of
// things that add up.
std::string totals_text(const Verdict& verdict) {
    std::string text;
    for (const measure::Metric& metric : measure::metrics()) {
        int hurt = 0, helped = 0;
        double before = 0, after = 0;
        for (const Finding& finding : verdict.findings) {
            if (finding.metric != metric.name || !finding.before || !finding.after) continue;
            before += *finding.before;
            after += *finding.after;
            if (*finding.after > *finding.before) ++hurt;
            if (*finding.after < *finding.before) ++helped;
        }
        if (hurt + helped == 0) continue;
        text += fmt::format("  {:<14} helped {:>4}, hurt {:>4}", metric.name, helped, hurt);
        if (!metric.is_error) text += fmt::format(", sum {:g} -> {:g}", before, after);
        text += "\n";
    }
    return text.empty() ? text : "\ntotals:\n" + text;
}

// "march at templates/search/x.cpp:25: 12 slots, before 10" holds a place: file and line.
struct Place {
    std::string file;
    int line = 0;
};
std::optional<Place> place_of(const Finding& finding) {
    const std::size_t at = finding.where.find(" at ");
    if (at == std::string::npos) return std::nullopt;
    const std::size_t start = at + 4, colon = finding.where.find(':', start);
    if (colon == std::string::npos) return std::nullopt;
    const int line = std::atoi(finding.where.c_str() + colon + 1);
    if (line <= 0) return std::nullopt;
    return Place{finding.where.substr(start, colon - start), line};
}

Place place_or_budget(const Verdict& verdict, const Finding& finding) {
    return place_of(finding).value_or(Place{verdict.budget_file, std::max(1, finding.budget_line)});
}

std::string long_sentence(const Finding& finding) {
    std::string text = fmt::format("{}: {}", finding.name(), finding.sentence);
    if (!finding.where.empty()) text += fmt::format("; spent by {}", finding.where);
    return text;
}

// GitHub's escapes: of the message, and more of a property.
std::string escaped(const std::string& text, bool property) {
    std::string safe;
    for (char c : text) {
        if (c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ',')))
            safe += fmt::format("%{:02X}", static_cast<int>(c));
        else
            safe += c;
    }
    return safe;
}

// A path as the relative reference that SARIF wants.
std::string uri_of(const std::string& path) {
    constexpr std::string_view plain = "-._~/:@!$&'()*+,;=";
    std::string uri;
    for (const char c : path) {
        const auto byte = static_cast<unsigned char>(c);
        const bool alphanumeric = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                                  (byte >= 'a' && byte <= 'z');
        uri += alphanumeric || plain.find(c) != std::string_view::npos
                   ? std::string(1, c)
                   : fmt::format("%{:02X}", byte);
    }
    return uri;
}

Json json_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

}  // namespace

std::string to_text(const Verdict& verdict) {
    std::string text;
    int failures = 0, waived = 0;
    for (const Finding& finding : verdict.findings) {
        failures += finding.fails() ? 1 : 0;
        waived += finding.kind == Finding::Kind::Waived ? 1 : 0;
        if (finding.kind != Finding::Kind::Fine)
            text += failure_text(finding);
        else if (finding.metric.empty())
            text += fmt::format("{}: {}\n", finding.name(), finding.sentence);
    }
    text += changes_text("worse", changes(verdict, true));
    text += changes_text("better", changes(verdict, false));
    text += totals_text(verdict);
    for (const std::string& note : verdict.notes) text += fmt::format("note: {}\n", note);
    if (verdict.budget_file.empty()) {
        if (text.empty()) text = "no difference\n";
        return text;
    }
    if (!text.empty()) text += "\n";
    text += fmt::format("{}: {} failed, {} waived, {} checked\n",
                        verdict.passes() ? "within budget" : "over budget", failures, waived,
                        verdict.findings.size());
    return text;
}

std::string to_json(const Verdict& verdict) {
    Json findings = Json::array();
    for (const Finding& finding : verdict.findings)
        findings.push_back({{"kind", word_of(finding.kind)},
                            {"surface", finding.surface},
                            {"target", finding.target},
                            {"settings", finding.settings},
                            {"metric", finding.metric},
                            {"before", json_number(finding.before)},
                            {"after", json_number(finding.after)},
                            {"sentence", finding.sentence},
                            {"where", finding.where},
                            {"command", finding.command},
                            {"budget_line", finding.budget_line}});
    const Json json = {{"schema", "intaglio.check"}, {"version", 1},
                       {"passes", verdict.passes()}, {"budgets", verdict.budget_file},
                       {"findings", findings},       {"notes", verdict.notes}};
    return json.dump(2) + "\n";
}

std::string to_junit(const Verdict& verdict) {
    pugi::xml_document document;
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    auto suite = document.append_child("testsuites").append_child("testsuite");
    suite.append_attribute("name") = "intaglio check";
    const auto count = [&](const auto& accepts) {
        return static_cast<int>(
            std::count_if(verdict.findings.begin(), verdict.findings.end(), accepts));
    };
    suite.append_attribute("tests") = static_cast<int>(verdict.findings.size());
    suite.append_attribute("failures") = count([](const Finding& f) { return f.fails(); });
    suite.append_attribute("skipped") =
        count([](const Finding& f) { return f.kind == Finding::Kind::Waived; });
    for (const Finding& finding : verdict.findings) {
        auto test = suite.append_child("testcase");
        test.append_attribute("classname") = finding.name().c_str();
        test.append_attribute("name") = finding.metric.empty() ? "variant" : finding.metric.c_str();
        if (finding.kind == Finding::Kind::Fine) continue;
        auto outcome = test.append_child(finding.fails() ? "failure" : "skipped");
        outcome.append_attribute("message") = finding.sentence.c_str();
        if (finding.fails())
            outcome.append_child(pugi::node_pcdata).set_value(failure_text(finding).c_str());
    }
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

std::string to_github(const Verdict& verdict) {
    std::string text;
    for (const Finding& finding : verdict.findings) {
        if (finding.kind == Finding::Kind::Fine) continue;
        const Place place = place_or_budget(verdict, finding);
        text +=
            fmt::format("::{} file={},line={},title={}::{}\n", finding.fails() ? "error" : "notice",
                        escaped(place.file, true), place.line, escaped("intaglio check", true),
                        escaped(long_sentence(finding), false));
    }
    for (const std::string& note : verdict.notes)
        text += fmt::format("::warning title=intaglio check::{}\n", escaped(note, false));
    return text;
}

std::string to_sarif(const Verdict& verdict) {
    Json rules = Json::array(), results = Json::array();
    for (const char* rule : {"over", "waived", "unknown", "vanished"})
        rules.push_back({{"id", rule}});
    for (const Finding& finding : verdict.findings) {
        if (finding.kind == Finding::Kind::Fine) continue;
        const Place place = place_or_budget(verdict, finding);
        results.push_back(
            {{"ruleId", word_of(finding.kind)},
             {"level", finding.fails() ? "error" : "note"},
             {"message", {{"text", long_sentence(finding)}}},
             {"locations",
              {{{"physicalLocation",
                 {{"artifactLocation", {{"uri", uri_of(place.file)}}},
                  {"region", {{"startLine", place.line}}}}}}}},
             {"partialFingerprints",
              {{"variant/metric", fmt::format("{} {}", finding.name(), finding.metric)}}}});
    }
    const Json json = {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                       {"version", "2.1.0"},
                       {"runs",
                        {{{"tool", {{"driver", {{"name", "intaglio check"}, {"rules", rules}}}}},
                          {"results", results}}}}};
    return json.dump(2) + "\n";
}

std::string to_patch(const std::string& file, const std::string& before, const std::string& after) {
    if (before == after) return {};
    const std::vector<std::string> old_lines = lines_of(before), new_lines = lines_of(after);
    // Both are sorted by variant and a variant has one line, so lines pair up by how they begin.
    const auto key = [](const std::string& line) {
        return line.substr(0, line.find(",\"metrics\""));
    };
    std::string text = fmt::format("--- a/{0}\n+++ b/{0}\n", file);
    std::size_t i = 0, j = 0;
    while (i < old_lines.size() || j < new_lines.size()) {
        if (i < old_lines.size() && j < new_lines.size() && old_lines[i] == new_lines[j]) {
            ++i, ++j;
            continue;
        }
        const bool only_old =
            j == new_lines.size() ||
            (i < old_lines.size() &&
             std::none_of(new_lines.begin() + static_cast<std::ptrdiff_t>(j), new_lines.end(),
                          [&](const std::string& line) { return key(line) == key(old_lines[i]); }));
        const bool only_new =
            !only_old && (i == old_lines.size() || key(old_lines[i]) != key(new_lines[j]));
        // Without context a hunk of no lines stands after the line of its number.
        text += fmt::format("@@ -{},{} +{},{} @@\n", only_new ? i : i + 1, only_new ? 0 : 1,
                            only_old ? j : j + 1, only_old ? 0 : 1);
        if (!only_new) text += fmt::format("-{}\n", old_lines[i++]);
        if (!only_old) text += fmt::format("+{}\n", new_lines[j++]);
    }
    return text;
}

}  // namespace intaglio::budget
