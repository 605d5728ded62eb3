// Places a vertex of the interface: pixels to clip space.
layout(push_constant, scalar) uniform Push {
    vec2 scale;   // clip units a pixel
    vec2 offset;  // clip units
} push;

layout(location = 0) in vec2 place;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 color;
layout(location = 0) out vec4 outColor;
layout(location = 1) out vec2 outTexel;

void main() {
    outColor = color;
    outTexel = texel;
    gl_Position = vec4(place * push.scale + push.offset, 0.0, 1.0);
}
