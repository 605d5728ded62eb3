// PCG (Jarzynski and Olano, "Hash functions for GPU rendering", 2020).

uint randomBits(inout uint state) {
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return word >> 22 ^ word;
}

// From 0 to less than 1.
float random(inout uint state) { return float(randomBits(state) >> 8) / 16777216.0; }

// The state for one of many sequences, of which each item has its own.
uint randomStart(uint item, uint sequence) {
    uint state = sequence;
    state = item ^ randomBits(state);
    randomBits(state);
    return state;
}
