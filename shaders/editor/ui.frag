// Colours a pixel of the interface. Colours are sRGB from end to end, as Dear ImGui means them.
layout(location = 0) in vec4 color;
layout(location = 1) in vec2 texel;
layout(location = 0) out vec4 outColor;
layout(set = 0, binding = 0) uniform sampler2D picture;

void main() { outColor = color * texture(picture, texel); }
