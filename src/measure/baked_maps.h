// The maps that techniques want baked from a height map, by the name of the sampler that reads them
// and baked when the first program reads one.  What each holds: docs/maps.md.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/measure/map_set.h"
#include "src/vulkan/texture.h"

namespace intaglio::measure {

class BakedMaps {
  public:
    BakedMaps(maps::Image heights, Filtering filtering);

    // Every name that there is a map for: "cone_map", "max_mip_map", ...
    static std::vector<std::string_view> names();

    // The texture behind a sampler's name; null where the name is none of names().  Lives as long
    // as this object.  May be called from several threads.  Errors: those of the bake.
    Result<const vulkan::Texture*> texture(const std::string& name);

  private:
    maps::Image heights_;
    Filtering filtering_;
    std::mutex mutex_;
    std::map<std::string, std::unique_ptr<vulkan::Texture>> baked_;
};

}  // namespace intaglio::measure
