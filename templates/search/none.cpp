// Plain bump mapping: the surface is where the polygon is, t = s.  Blinn, "Simulation of Wrinkled
// Surfaces", 1978.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class None : public Search {
  public:
    Hit find(const Relief&, const Ray& ray) const override { return {ray.uv, 1.0f, bool1(true)}; }
};

}  // namespace

dsl::Entry<dsl::Search> search_none() {
    return dsl::entry<dsl::Search, None>(
        "none", "Bump mapping without parallax: the coordinate stays where it is", "Blinn 1978");
}

}  // namespace intaglio::templates
