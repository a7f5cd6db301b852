#version 330 core

// march: vertex stage for glsl_330
// March the view ray down until a sample rises above it.
// Settings: taps = 8

layout(location = 0) in vec3 vertex_position;

out vec2 uv;
out vec3 view;

void main() {
    gl_Position = vec4(vertex_position, 1.0);
    uv = vertex_position.xx;
    view = vertex_position.xxx;
}
