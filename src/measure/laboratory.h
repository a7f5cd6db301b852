// Measures single cases: what sweeps, budgets and plans all call.  A laboratory has a device of its
// own and is used from one thread at a time; several may share what they make.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/measure/case.h"
#include "src/measure/shared.h"

namespace intaglio::measure {

struct LaboratoryOptions {
    std::string device;       // see vulkan::DeviceOptions
    bool validation = false;  // Vulkan validation layers; a message is an error
    int threads = 0;          // as in rows.h
};

// What the hits of a case are, pixel by pixel.
struct CaseHits {
    Maker maker = Maker::Device;
    vulkan::Picture picture;  // output=displaced
    std::vector<HitError> errors;
    std::shared_ptr<const ExactPicture> exact;
    Executed executed;
};
WorstPixel pixel_of(const CaseHits& hits, Direction view, int x, int y);

class Laboratory {
  public:
    // The catalogue must outlive the laboratory.  Errors: those of vulkan::Device::create.
    static Result<Laboratory> create(const dsl::Catalogue& catalogue,
                                     const LaboratoryOptions& options,
                                     std::shared_ptr<Shared> shared = std::make_shared<Shared>());

    // Name and driver.
    std::string device() const;

    // Everything.  A variant that its target refuses is no error: CaseMetrics::refusal says why.
    // Errors: those of our own, and of the device.
    Result<CaseMetrics> measure(const Case& what, const CaseMap& map);
    // The hits alone.  Errors as of measure, and those of compile_row.
    Result<CaseHits> hits(const Case& what, const CaseMap& map);
    // What the case draws, and what it would at the exact hits: the same normal source and shading
    // on the device in fp32, with the exact visibility of the light where the surface's shadow
    // looks at the light, else with the surface's own.
    struct Pictures {
        vulkan::Picture drawn;
        std::shared_ptr<const Result<vulkan::Picture>> exact;
    };
    Result<Pictures> pictures(const Case& what, const CaseMap& map);

    Laboratory(Laboratory&&) noexcept;
    Laboratory& operator=(Laboratory&&) noexcept;
    ~Laboratory();

  private:
    struct State;
    explicit Laboratory(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace intaglio::measure
