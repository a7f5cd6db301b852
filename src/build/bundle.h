// One variant as a build delivers it: its files, what an application binds, who accepted it.  A
// pure function of the order, so that it can be cached, shared and made on another machine.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "src/build/interface.h"
#include "src/build/names.h"
#include "src/plan/order.h"

namespace intaglio::build {

struct BundleFile {
    std::string name;  // "quay.ps_2_0.psh"
    ir::Stage stage = ir::Stage::Vertex;
    FileKind kind = FileKind::Text;
    std::string entry;  // the entry point that an application names
    std::string bytes;
    bool operator==(const BundleFile&) const = default;
};

struct Bundle {
    std::vector<BundleFile> files;  // in the order of stage_files
    Interface interface;
    std::vector<std::string> witnesses;  // what accepted it, in order
    std::vector<std::string> notes;      // what its user must know
    std::vector<plan::Figure> slots;     // Direct3D 9: what the bytecode uses of its limits
    // The samplers of baked maps with the settings that they must be baked with ("shininess=32").
    std::vector<std::pair<std::string, std::string>> baked;
    bool operator==(const Bundle&) const;
};

struct BundleOptions {
    // The whole chain of witnesses (judge_variant), which asks tools that no build needs.
    bool judge = false;
};

// Errors: those of make_variant, accept_variant and judge_variant; "order-split": the order is one
// pass of several; "unknown-target".
Result<Bundle> make_bundle(const dsl::Catalogue& catalogue, const plan::Order& order,
                           const BundleOptions& options = {});

// Everything that make_bundle depends on, as 32 hexadecimal digits: the program as recorded, the
// rest of the request, the options, this tool.
Result<std::string> bundle_key(const dsl::Catalogue& catalogue, const plan::Order& order,
                               const BundleOptions& options);

// As bytes and back, for the cache and between the actions of a build.  Errors: "bundle-broken".
std::string to_bytes(const Bundle& bundle);
Result<Bundle> bundle_of(const std::string& bytes);

// Of all code that shapes an output, with the versions of the tools that are compiled in.
std::string tool_id();

}  // namespace intaglio::build
