// The edges of a scene for Ninja.  One rule with the command as a variable: what differs from edge
// to edge is all there is.
#include <fmt/format.h>

#include "src/build/steps.h"
#include "src/maps/files.h"

namespace intaglio::build {
namespace {

namespace fs = std::filesystem;

// A path of a build line.
std::string escaped(const std::string& path) {
    std::string text;
    for (const char c : path) {
        if (c == ' ' || c == ':' || c == '$') text += '$';
        text += c;
    }
    return text;
}

// The value of a variable: only the dollar means something there.
std::string value(const std::string& text) {
    std::string escaped_text;
    for (const char c : text) escaped_text += c == '$' ? std::string("$$") : std::string(1, c);
    return escaped_text;
}

struct Edge {
    std::vector<std::string> outputs, inputs;
    std::vector<std::string> command;
    std::string about;
    std::string depfile = {};
    std::string dyndep = {};  // a file that names further outputs
};

class Writer {
  public:
    explicit Writer(const BuildOptions& options) : options_(options) {}

    std::string in_folder(const std::string& name) const {
        return (options_.output / name).string();
    }
    std::string state(const std::string& name) const {
        return (options_.output / state_folder / name).string();
    }
    // `TOOL build WORDS -o DIR`, with what every step is told.
    std::vector<std::string> command(std::vector<std::string> words) const {
        std::vector<std::string> all = {options_.tool.string(), "build"};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), {"-o", options_.output.string(), "-q"});
        if (options_.cache.empty())
            all.emplace_back("--no-cache");
        else
            all.insert(all.end(), {"--cache", options_.cache.string()});
        return all;
    }

    void add(const Edge& edge) {
        text_ += "build";
        for (const std::string& path : edge.outputs) text_ += " " + escaped(path);
        text_ += ": intaglio";
        for (const std::string& path : edge.inputs) text_ += " " + escaped(path);
        // The program makes what is made, so it is an input of everything.
        text_ += " | " + escaped(options_.tool.string());
        if (!edge.dyndep.empty()) text_ += " || " + escaped(edge.dyndep);
        text_ += "\n  cmd =";
        for (const std::string& word : edge.command) text_ += " " + value(maps::shell_quoted(word));
        text_ += "\n  about = " + value(edge.about) + "\n";
        if (!edge.depfile.empty()) text_ += "  depfile = " + value(edge.depfile) + "\n";
        if (!edge.dyndep.empty()) text_ += "  dyndep = " + value(edge.dyndep) + "\n";
        text_ += "\n";
        outputs_.insert(outputs_.end(), edge.outputs.begin(), edge.outputs.end());
    }

    std::string text(const std::string& scene) const {
        std::string all =
            "# Made by `intaglio build --ninja`.\n\n"
            "rule intaglio\n  command = $cmd\n  description = $about\n  restat = 1\n\n" +
            text_ + "build intaglio-" + scene + ": phony";
        for (const std::string& path : outputs_) all += " " + escaped(path);
        return all + "\n";
    }

  private:
    const BuildOptions& options_;
    std::string text_;
    std::vector<std::string> outputs_;
};

std::vector<std::string> scene_words(const BuildOptions& options) {
    std::vector<std::string> words = {options.scene.string()};
    std::string targets;
    for (const std::string& target : options.targets)
        targets += (targets.empty() ? "" : ",") + target;
    if (!targets.empty()) words.insert(words.end(), {"--targets", targets});
    return words;
}

std::vector<std::string> with(std::vector<std::string> words, std::vector<std::string> more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

std::vector<std::string> inputs_of(const scene::Scene& scene) {
    std::vector<std::string> paths;
    for (const fs::path& input : scene.inputs) paths.push_back(input.string());
    return paths;
}

void add_orders(Writer& writer, const scene::Scene& scene, const BuildOptions& options) {
    Edge edge;
    edge.outputs.push_back(writer.state("scene.json"));
    for (const scene::SceneSurface& surface : scene.surfaces)
        for (const std::string& target : surface.targets)
            edge.outputs.push_back(writer.in_folder(order_file(surface.name + "." + target)));
    edge.inputs = inputs_of(scene);
    edge.depfile = writer.state("orders.d");
    edge.command = writer.command(
        with(scene_words(options), {"--step", "orders", "--depfile", "--depfile-name", edge.depfile,
                                    "--depfile-target", edge.outputs.front()}));
    edge.about = fmt::format("Planning {}", scene.name);
    writer.add(edge);
}

void add_variants(Writer& writer, const scene::SceneSurface& surface, const BuildOptions& options,
                  std::vector<std::string>& made) {
    for (const std::string& target : surface.targets) {
        const std::string name = surface.name + "." + target;
        const std::string order = writer.in_folder(order_file(name));
        Edge edge;
        for (const std::string& file : variant_files(surface.name, *find_target(target)))
            edge.outputs.push_back(writer.in_folder(file));
        edge.outputs.push_back(writer.state(name + ".bundle"));
        edge.inputs = {order};
        std::vector<std::string> words = {"--order", order};
        if (options.judge) words.emplace_back("--judge");
        edge.command = writer.command(words);
        edge.about = fmt::format("Shaders of {}", name);
        writer.add(edge);
        made.push_back(order);
        made.push_back(edge.outputs.back());
    }
}

// What is baked follows from the variants, so one edge names the files and the next one makes them.
void add_maps_edges(Writer& writer, const scene::Scene& scene, const BuildOptions& options,
                    const std::vector<std::string>& made) {
    Edge names;
    names.outputs = {writer.state(std::string(map_names_file))};
    names.inputs = with(inputs_of(scene), made);
    names.command = writer.command(with(scene_words(options), {"--step", "map-names"}));
    names.about = fmt::format("Names of the maps of {}", scene.name);
    writer.add(names);
    Edge maps;
    for (const scene::SceneSurface& surface : scene.surfaces)
        maps.outputs.push_back(writer.state(surface.name + ".maps.json"));
    maps.inputs = names.inputs;
    maps.command = writer.command(with(scene_words(options), {"--step", "maps"}));
    maps.about = fmt::format("Maps of {}", scene.name);
    maps.dyndep = names.outputs.front();
    writer.add(maps);
}

}  // namespace

std::string ninja_outputs_text(const fs::path& output, const std::vector<fs::path>& more) {
    std::string text = "ninja_dyndep_version = 1\nbuild " + escaped(output.string());
    if (!more.empty()) text += " |";
    for (const fs::path& path : more) text += " " + escaped(path.string());
    return text + ": dyndep\n  restat = 1\n";
}

Result<std::string> ninja_text(const scene::Scene& scene, const BuildOptions& options) {
    for (const std::string& path :
         with({options.output.string(), options.tool.string(), options.cache.string()},
              inputs_of(scene)))
        if (path.find_first_of("\n\r") != std::string::npos)
            return input_error("ninja-path",
                               "a path holds a line break, which Ninja has no way to say");
    Writer writer(options);
    add_orders(writer, scene, options);
    std::vector<std::string> made;  // orders and bundles
    for (const scene::SceneSurface& surface : scene.surfaces)
        add_variants(writer, surface, options, made);
    add_maps_edges(writer, scene, options, made);

    Edge manifest;
    manifest.inputs = made;
    manifest.inputs.push_back(writer.state("scene.json"));
    const std::vector<std::string> name_space =
        options.name_space.empty() ? std::vector<std::string>()
                                   : std::vector<std::string>{"--namespace", options.name_space};
    for (const scene::SceneSurface& surface : scene.surfaces) {
        Edge edge;
        edge.outputs = {writer.in_folder(header_file(surface.name))};
        edge.inputs = {writer.state("scene.json"), writer.state(surface.name + ".maps.json")};
        for (const std::string& target : surface.targets)
            for (const std::string& path :
                 {writer.in_folder(order_file(surface.name + "." + target)),
                  writer.state(surface.name + "." + target + ".bundle")})
                edge.inputs.push_back(path);
        edge.command =
            writer.command(with({"--step", "header", "--surface", surface.name}, name_space));
        edge.about = fmt::format("Header of {}", surface.name);
        writer.add(edge);
        manifest.inputs.push_back(writer.state(surface.name + ".maps.json"));
        manifest.inputs.push_back(edge.outputs.front());
    }
    manifest.outputs = {writer.in_folder(std::string(manifest_file))};
    manifest.command = writer.command(with({"--step", "manifest"}, name_space));
    manifest.about = fmt::format("Manifest of {}", scene.name);
    writer.add(manifest);
    return writer.text(scene.name);
}

}  // namespace intaglio::build
