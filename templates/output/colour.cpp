// The shaded colour, linear, alpha 1.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Colour : public Output {
  public:
    std::string name() const override { return "colour"; }
    bool shaded() const override { return true; }
    float4 write(const Hit&, float1, float3 colour) const override { return {colour, 1.0f}; }
};

}  // namespace

dsl::Entry<dsl::Output> output_colour() {
    return dsl::entry<dsl::Output, Colour>("colour", "The shaded colour", "");
}

}  // namespace intaglio::templates
