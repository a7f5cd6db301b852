// The generator as a library, without the program: the pixel shader of a surface on a target, to
// stdout.
#include <cstdio>

#include "generator/dsl/surface.h"
#include "generator/target/target.h"
#include "templates/all_techniques.h"

int main(int argument_count, char** arguments) {
    using namespace intaglio;
    if (argument_count != 3) return 2;
    const Target* target = find_target(arguments[2]);
    const auto surface = dsl::make_surface(templates::all_techniques(), arguments[1]);
    if (!target || !surface) return 2;
    const auto program = dsl::record_surface(*surface, {arguments[2], {}, false});
    if (!program) return 2;
    const auto emitted = emit(*program, *target);
    if (!emitted) return 2;
    return std::fputs(emitted->pixel.text.c_str(), stdout) < 0;
}
