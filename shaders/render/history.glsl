// What is known of a pixel's ambient occlusion: how open it is, 0 to 1, and how many rays say so.

uint packHistory(float openness, uint rays) { return uint(openness * 65535.0 + 0.5) | min(rays, 0xffff) << 16; }
float opennessOf(uint history) { return float(history & 0xffff) / 65535.0; }
