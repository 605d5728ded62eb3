// Colours a pixel of what has one colour and no picture.
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 outColor;

void main() { outColor = color; }
