// The sums before each group of counts.
#include "sort/sort.glsl"
#include "mesher/top.glsl"

void main() { sumUp((push.keys + SORT_SUM_LANES * SORT_SUM_EACH - 1) / (SORT_SUM_LANES * SORT_SUM_EACH)); }
