// Fronts as Markdown and as scripts for gnuplot.
#include "src/report/front.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;

std::string class_of(const Json& map) {
    return map.contains("class") ? map.at("class").get<std::string>()
                                 : map.at("name").get<std::string>();
}

std::string short_name(const PageData& page, std::size_t variant) {
    const VariantRequest& request = page.variants[variant];
    std::string name = request.surface;
    for (const auto& [knob, value] : request.knobs) name += fmt::format(" {}={}", knob, value);
    return name;
}

// The same for a plot: values alone.
std::string label_of(const PageData& page, std::size_t variant) {
    std::string name = page.variants[variant].surface;
    for (const auto& [knob, value] : page.variants[variant].knobs) name += " " + value;
    return name;
}

// Three digits, as people read them.
std::string digits(double value) {
    if (value == 0) return "0";
    if (value < least_seen) return "<0.001";
    return value >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string maps_in(const PageData& page, const std::string& map_class) {
    std::vector<std::string> names;
    for (const Json& map : page.json.at("maps"))
        if (class_of(map) == map_class) names.push_back(map.at("name"));
    return fmt::format("{}", fmt::join(names, ", "));
}

// The cheapest variant within the limits, per class and elevation.
std::string cheapest_table(const PageData& page, double texels, double missed) {
    std::string head = fmt::format(
        "**The cheapest with p95 at most {:g} {} and at most {:g} % of the hits missed** (texture "
        "reads "
        "per pixel)\n\n| maps |",
        texels, texels == 1 ? "texel" : "texels", missed);
    std::string line = "\n|---|", rows;
    for (double elevation : elevations(page)) {
        head += fmt::format(" {:g}° |", elevation);
        line += "---|";
    }
    for (const std::string& map_class : map_classes(page)) {
        rows += fmt::format("| {} |", map_class);
        for (double elevation : elevations(page)) {
            const std::vector<FrontPoint> points = front_points(page, map_class, elevation);
            const auto fits = std::find_if(points.begin(), points.end(), [&](const FrontPoint& p) {
                return p.p95 <= texels && p.missed <= missed;
            });
            rows += fits == points.end()
                        ? std::string(" none |")
                        : fmt::format(" {} ({}) |", short_name(page, fits->variant),
                                      digits(fits->reads));
        }
        rows += "\n";
    }
    return head + line + "\n" + rows + "\n";
}

// The worst p95 of a variant from an elevation, over all maps; empty where nobody measured it.
std::optional<double> worst_p95(const PageData& page, std::size_t variant, double elevation,
                                const std::string& arithmetic) {
    std::optional<double> worst;
    for (const Json& item : page.json.at("cases")) {
        const Json& p95 = item.at("hits").at("p95");
        if (item.at("variant") != variant || item.at("view").at("elevation") != elevation ||
            item.value("arithmetic", "fp32") != arithmetic || p95.is_null())
            continue;
        worst = std::max(worst.value_or(0), p95.get<double>());
    }
    return worst;
}

// Variants that were measured in less than fp32; empty where none was.
std::string arithmetic_table(const PageData& page) {
    std::set<std::size_t> narrow;
    for (const Json& item : page.json.at("cases"))
        if (item.value("arithmetic", "fp32") != "fp32")
            narrow.insert(item.at("variant").get<std::size_t>());
    if (narrow.empty()) return {};
    std::string text =
        "### Arithmetic\n\nThe same bytecode interpreted in fp32, in the 24 bits of R300 and in 16 "
        "(every instruction _pp): p95 in texels, the worst of all maps.\n\n| variant |";
    std::string line = "\n|---|", rows;
    for (double elevation : elevations(page)) {
        text += fmt::format(" {:g}° |", elevation);
        line += "---|";
    }
    for (std::size_t variant : narrow) {
        rows += fmt::format("| {}, {} |", short_name(page, variant), page.variants[variant].target);
        for (double elevation : elevations(page)) {
            std::vector<std::string> cells;
            for (const char* arithmetic : {"fp32", "fp24", "fp16"}) {
                const auto p95 = worst_p95(page, variant, elevation, arithmetic);
                cells.push_back(p95 ? digits(*p95) : "–");
            }
            rows += fmt::format(" {} |", fmt::join(cells, ", "));
        }
        rows += "\n";
    }
    return text + line + "\n" + rows + "\n";
}

std::string front_table(const PageData& page, const std::string& map_class) {
    std::string text =
        "| elevation | on the front | reads | p95, texels | missed | SPIR-V arithmetic |\n"
        "|---|---|---|---|---|---|\n";
    for (double elevation : elevations(page))
        for (const FrontPoint& point : front_points(page, map_class, elevation)) {
            if (!point.on_front) continue;
            text += front_row(page, elevation, point);
        }
    return text + "\n";
}

// A panel for each elevation: every variant a dot, the front a line with names.
std::string plot_script(const PageData& page, const std::string& map_class) {
    const std::vector<double> angles = elevations(page);
    const std::size_t columns = std::min<std::size_t>(2, angles.size());
    const std::size_t rows = (angles.size() + columns - 1) / columns;
    std::string script = fmt::format(
        "set terminal svg size {},{} background rgb 'white' font 'sans-serif,12' noenhanced\n"
        "set multiplot layout {},{} title '{}: p95 of the hit error against texture reads'\n"
        "set logscale xy\nset grid lc rgb '#dddddd' lt 1\nset key off\n"
        "set xrange [0.4:200]\nset yrange [0.0008:400]\nset xtics (1, 2, 5, 10, 20, 50, 100)\n"
        "set ytics ('<= 0.001' 0.001, 0.01, 0.1, 1, 10, 100)\n"
        "set xlabel 'texture reads per pixel'\nset ylabel 'p95, texels'\n",
        columns * 480, rows * 340 + 30, rows, columns, file_name(map_class));
    for (double elevation : angles) {
        std::string all, front;
        double named = std::numeric_limits<double>::infinity();
        for (const FrontPoint& point : front_points(page, map_class, elevation)) {
            const double y = std::max(point.p95, least_seen);
            const std::string at = fmt::format("{:.6g} {:.6g}", std::max(point.reads, 0.5), y);
            all += at + "\n";
            if (!point.on_front) continue;
            // A name stands where no other is: names are half as high as the error's double.
            const bool has_room = y * 1.9 < named;
            front += fmt::format("{} \"{}\"\n", at, has_room ? label_of(page, point.variant) : "");
            if (has_room) named = y;
        }
        script += fmt::format(
            "set title 'seen from {:g} degrees'\n$all << EOD\n{}EOD\n$front << EOD\n{}EOD\n"
            "plot $all with points pt 7 ps 0.4 lc rgb '#999999', $front with steps lw 1.5 lc rgb "
            "'#0072b2', $front with points pt 7 ps 0.7 lc rgb '#0072b2', $front using 1:($2*1.4):3 "
            "with labels left offset 0.5,0 font ',10' textcolor rgb '#222222'\n",
            elevation, all, front);
    }
    return script + "unset multiplot\n";
}

}  // namespace

std::string file_name(std::string name) {
    for (char& c : name)
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
    return name;
}

std::vector<std::string> map_classes(const PageData& page) {
    std::vector<std::string> classes;
    for (const Json& map : page.json.at("maps"))
        if (std::find(classes.begin(), classes.end(), class_of(map)) == classes.end())
            classes.push_back(class_of(map));
    return classes;
}

std::vector<double> elevations(const PageData& page) {
    std::set<double, std::greater<>> angles;
    for (const Json& item : page.json.at("cases"))
        angles.insert(item.at("view").at("elevation").get<double>());
    return {angles.begin(), angles.end()};
}

std::vector<FrontPoint> front_points(const PageData& page, const std::string& map_class,
                                     double elevation) {
    std::map<std::size_t, std::pair<FrontPoint, int>> by_variant;
    for (const Json& item : page.json.at("cases")) {
        const std::size_t variant = item.at("variant");
        const Json& map = page.json.at("maps")[item.at("map").get<std::size_t>()];
        const Json& hits = item.at("hits");
        if (class_of(map) != map_class || item.at("view").at("elevation") != elevation ||
            item.value("arithmetic", "fp32") != "fp32" || hits.at("p95").is_null() ||
            !page.json.at("variants")[variant].at("d3d9").is_null())
            continue;
        auto& [point, count] = by_variant[variant];
        const double missed =
            100 * hits.at("missed").get<double>() / hits.at("pixels").get<double>();
        point.variant = variant;
        point.reads += item.at("reads").at("mean").get<double>();
        point.p95 = std::max(point.p95, hits.at("p95").get<double>());
        point.missed = std::max(point.missed, missed);
        ++count;
    }
    std::vector<FrontPoint> points;
    for (auto& [variant, sum] : by_variant) {
        sum.first.reads /= sum.second;
        points.push_back(sum.first);
    }
    std::stable_sort(points.begin(), points.end(), [](const FrontPoint& a, const FrontPoint& b) {
        return std::pair(a.reads, a.p95) < std::pair(b.reads, b.p95);
    });
    double best = std::numeric_limits<double>::infinity();
    for (FrontPoint& point : points) {
        const double error = std::max(point.p95, least_seen);
        point.on_front = error < best;
        best = std::min(best, error);
    }
    return points;
}

std::string front_row(const PageData& page, double elevation, const FrontPoint& point) {
    const Json& spirv = page.json.at("variants")[point.variant].at("spirv");
    return fmt::format("| {:g}° | {} | {} | {} | {} % | {} |\n", elevation,
                       short_name(page, point.variant), digits(point.reads), digits(point.p95),
                       digits(point.missed), spirv.is_null() ? "" : spirv.at("alu").dump());
}

std::string extent(std::size_t variants, std::size_t maps, std::size_t elevations) {
    return fmt::format("{} variants on {} maps, from {} elevations.\n", variants, maps, elevations);
}

FrontDocument front_document(const PageData& page, const std::string& pictures) {
    FrontDocument document;
    document.text =
        extent(page.variants.size(), page.json.at("maps").size(), elevations(page).size()) + "\n";
    for (double limit : {1.0, 0.1}) document.text += cheapest_table(page, limit, limit);
    document.text += arithmetic_table(page);
    for (const std::string& map_class : map_classes(page)) {
        document.plots.push_back({file_name(map_class), plot_script(page, map_class)});
        document.text += fmt::format("### {}\n\n", map_class);
        const std::string maps = maps_in(page, map_class);
        if (maps != map_class) document.text += fmt::format("Maps: {}.\n\n", maps);
        document.text += fmt::format("![{}: cost against error]({}/{}.svg)\n\n", map_class,
                                     pictures, file_name(map_class)) +
                         front_table(page, map_class);
    }
    return document;
}

Result<std::string> with_front(const std::string& text, const std::string& made) {
    const std::size_t begin = text.find(front_begin), end = text.find(front_end);
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        return input_error(
            "no-marks", fmt::format("the document has no place for what is made: a line '{}' and, "
                                    "after it, a line '{}'",
                                    front_begin, front_end));
    return text.substr(0, begin) + front_begin + "\n\n" + made + text.substr(end);
}

}  // namespace intaglio::report
