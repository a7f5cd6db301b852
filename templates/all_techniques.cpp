// The tables.
#include "templates/all_techniques.h"

namespace intaglio::templates {

dsl::Catalogue all_techniques() {
    return {
        .searches = {search_none(), search_parallax(), search_parallax_limited(),
                     search_parallax_iterative(), search_steep_parallax(),
                     search_parallax_occlusion(), search_relief(), search_relief_secant(),
                     search_contact_refinement(), search_exact()},
        .shadows = {shadow_none(), shadow_march(), shadow_fur_depth()},
        .normals = {normal_map()},
        .shadings = {shading_phong()},
        .outputs = {output_colour(), output_displaced()},
        .vertex_works = {vertex_tangent_space()},
        .presets =
            {
                {"bump", "search=none"},
                {"fur", "search=steep_parallax,shadow=fur_depth"},
                {"steep_parallax_shadowed", "search=steep_parallax,shadow=march"},
            },
    };
}

}  // namespace intaglio::templates
