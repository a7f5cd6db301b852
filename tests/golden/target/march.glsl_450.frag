#version 450
#extension GL_EXT_control_flow_attributes : require

// march: pixel stage for glsl_450
// March the view ray down until a sample rises above it.
// Settings: taps = 8

layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 view;

layout(set = 0, binding = 1, std140) uniform PixelUniforms {
    float scale;  // depth of the relief in texture units
};
// height in red: 1 is the polygon, 0 the deepest
layout(set = 0, binding = 2) uniform sampler2D height_map;

layout(location = 0) precise out vec4 colour;

void main() {
    vec2 reach = view.xy / view.z * scale;

    // Walk down the ray until a sample of the height profile rises above it.
    float above = textureLod(height_map, uv, 0.0).x - 1.0;
    float t = 0.0;
    float below = above;
    [[dont_unroll]] for (int i = 0; i < 8; ++i) {
        if (below >= 0.0) break;
        t = float(i + 1) * 0.125;
        precise vec2 at = uv - reach * t;
        above = below;
        below = textureLod(height_map, at, 0.0).x - (1.0 - t);
    }

    // Show how deep the ray went.
    float depth = t - 0.125 * (below / (below - above));
    colour = vec4(vec3(depth), 1.0);
}
