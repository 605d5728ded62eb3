// Microfacets (GGX with the height-correlated masking of Smith; Heitz, "Understanding the masking-shadowing function", 2014),
// in the frame of the normal, z outwards. `alpha` is the square of a roughness.

float lambda(float cosine, float alpha) {
    float c2 = max(cosine * cosine, 1e-8);
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - c2) / c2) - 1.0);
}

// Of facets that `from` sees, the share that l sees too.
float unmasked(vec3 from, vec3 l, float alpha) {
    float seen = 1.0 + lambda(from.z, alpha);
    return seen / (seen + lambda(l.z, alpha));
}

// Radiance per irradiance, times the cosine of l, of facets that reflect everything.
float lobe(vec3 from, vec3 l, float alpha) {
    vec3 h = normalize(from + l);
    float a2 = alpha * alpha, spread = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    float shape = 1.0 / (3.14159265 * a2 * spread * spread);
    return shape / (1.0 + lambda(from.z, alpha) + lambda(l.z, alpha)) / (4.0 * max(from.z, 1e-4));
}

// A facet, as often as `from` sees it (Heitz, "Sampling the GGX distribution of visible normals", 2018).
vec3 facet(vec3 from, float alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * from.xy, from.z));
    float across = dot(stretched.xy, stretched.xy);
    vec3 x = across > 1e-12 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(across) : vec3(1, 0, 0), y = cross(stretched, x);
    float r = sqrt(u.x), angle = 6.2831853 * u.y, s = 0.5 * (1.0 + stretched.z);
    float a = r * cos(angle), b = mix(sqrt(max(1.0 - a * a, 0.0)), r * sin(angle), s);
    vec3 h = a * x + b * y + sqrt(max(1.0 - a * a - b * b, 0.0)) * stretched;
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-6)));
}

float fifth(float x) {
    float x2 = x * x;
    return x2 * x2 * x;
}

// Share of the light that a smooth surface between two media reflects: Fresnel's, of both polarisations. `cosine` is that of the
// arriving light, `ratio` the index of refraction behind over that before.
float fresnel(float cosine, float ratio) {
    float beyond = ratio * ratio - 1.0 + cosine * cosine;
    if (beyond <= 0.0) return 1.0;
    float g = sqrt(beyond), across = (g - cosine) / (g + cosine), along = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * across * across * (1.0 + along * along);
}
