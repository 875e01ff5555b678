// Sums along a row of nodes with water around each column of texels. x: from the texel, spacings; h: height; w: weight.
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "height_map_kernel.glsl"
layout(location = 0) out vec4 moments; // Σw, Σwx, Σwxx, Σwh
layout(location = 1) out vec4 more;    // Σwxh; lowest h, highest h; –

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  Window w = window(texel.x);
  int row = texel.y * nodes.x;
  moments = vec4(0.0);
  more = vec4(0.0, DRY, -DRY, 0.0);
  for (int i = w.first; i <= w.last; ++i) {
    float h = heights[row + mirrored(i, nodes.x)], x = float(i) - w.at;
    if (h >= DRY) continue;
    float weighted = weight(x);
    moments += weighted * vec4(1.0, x, x * x, h);
    more = vec4(more.x + weighted * x * h, min(more.y, h), max(more.z, h), 0.0);
  }
}
#endif
