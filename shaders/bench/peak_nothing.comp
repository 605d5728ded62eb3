// Does nothing, to measure what a dispatch costs.
layout(local_size_x = 1) in;

void main() {}
