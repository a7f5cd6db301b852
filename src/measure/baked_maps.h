// The maps that techniques want baked from a height map, by the name of the sampler that reads
// them: from a file that was given, or baked when the first program reads one.  What each holds:
// docs/maps.md.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/maps/provenance.h"
#include "src/measure/map_set.h"
#include "src/vulkan/texture.h"

namespace intaglio::measure {

// What a file of that kind has to be to stand in for what is baked here.  Error "unknown-bake": no
// technique reads that kind.
Result<maps::WantedBake> wanted_bake(const std::string& kind, const std::string& heights,
                                     const std::string& source);

// What lies behind a sampler's name: the kind of `intaglio bake` and the settings that every
// technique expects; kind "" for the heights themselves, texel by texel.  Nothing where the name is
// none of BakedMaps::names().
struct BakeBehind {
    std::string kind;
    maps::BakeSettings settings;
};
std::optional<BakeBehind> bake_behind(std::string_view sampler);

class BakedMaps {
  public:
    BakedMaps(const MapSet& set, Filtering filtering);

    // Every name that there is a map for: "cone_map", "max_mip_map", ...
    static std::vector<std::string_view> names();

    // The texture behind a sampler's name, baked with the settings that the sampler declares
    // ("shininess=32"; empty: as it is by default); null where the name is none of names().  Lives
    // as long as this object.  May be called from several threads.  Errors: those of the bake, of
    // maps::check_pairing where the file that was given has other settings; "bake-size" where it
    // has not the size that its settings say.
    Result<const vulkan::Texture*> texture(const std::string& name,
                                           const std::string& settings = {});
    // Error "bake-unread": a file was given that no texture was made of.
    Status check_all_read();

  private:
    Result<vulkan::Texture> made(std::string_view name, const maps::BakeSettings& settings);

    maps::Image heights_;
    std::map<std::string, maps::BakedFile> files_;
    std::string source_;
    Filtering filtering_;
    std::mutex mutex_;
    std::map<std::string, std::unique_ptr<vulkan::Texture>> baked_;  // by name and settings
    std::set<std::string> read_;                                     // kinds of files_
};

}  // namespace intaglio::measure
