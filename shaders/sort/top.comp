// The sums before each group of counts.
#include "sort/sort.glsl"
#define TOP_SUMS 4
#include "lib/top.glsl"

void main() { sumUp((push.keys + SORT_SUM_LANES * SORT_SUM_EACH - 1) / (SORT_SUM_LANES * SORT_SUM_EACH)); }
