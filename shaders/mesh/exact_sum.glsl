// Sums that are the same in any order: of numbers in two integers each, a whole part and a fraction. Numbers are
// given in units of which they are at most one; up to 4096 of them may be added, and all is kept that is above 2^-36.

struct ExactSum {
    ivec3 whole, fraction;
};
const float kWhole = 262144.0;

void add(inout ExactSum sum, vec3 x, bool counts) {
    vec3 scaled = counts ? x * kWhole : vec3(0), whole = roundEven(scaled);
    sum.whole += ivec3(whole);
    sum.fraction += ivec3(roundEven((scaled - whole) * kWhole));
}
vec3 valueOf(ExactSum sum) { return (vec3(sum.whole) + vec3(sum.fraction) / kWhole) / kWhole; }
