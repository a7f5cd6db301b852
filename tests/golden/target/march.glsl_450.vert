#version 450

// march: vertex stage for glsl_450
// March the view ray down until a sample rises above it.
// Settings: taps = 8

layout(location = 0) in vec3 vertex_position;

precise gl_Position;
layout(location = 0) precise out vec2 uv;
layout(location = 1) precise out vec3 view;

void main() {
    gl_Position = vec4(vertex_position, 1.0);
    uv = vertex_position.xx;
    view = vertex_position.xxx;
}
