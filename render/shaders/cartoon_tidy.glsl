// Outlines without the particles' scallops. The share of a pixel's surroundings that is water, weighed by a Gaussian about as
// wide as a particle, is one half along a smooth line through the scallops: that is the water's outline. The same vote is
// taken where water stands in front of other water: a pixel belongs to what most of its surroundings belong to.
//
// Water goes on up to the solids that it touches, so places on a body near the water have no vote (BODIES); the depth test of
// the light decides. Drops are one piece with their neighbours (DROPS), however they lie in depth.
#include "cartoon_map.glsl"
#ifndef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 params;          // standard deviation of the Gaussian, m; gap in depth between two pieces of water, m; m from solids
};

#ifdef BODIES
layout(binding = 1) uniform sampler2D background; // -, depth

// Does the background show a body there that water of an inverse depth may touch, at most `apart` (m) from it in depth?
bool touches(ivec2 at, float w, float apart) {
  ivec2 pixel = min(at * SCALE, ivec2(lens.zw) - 1);
  float depth = texelFetch(background, pixel, 0).a;
  float y = eye.y + dot(vec3(ray_of(pixel), -1.0), world_to_view[1].xyz) * depth;
  return abs(depth * w - 1.0) < apart * w && y > floor_plane.x + params.x;
}
#else
bool touches(ivec2 at, float w, float apart) {
  return false;
}
#endif

const int TAPS = 5;
#ifdef DROPS
const bool MERGED = true;
#else
const bool MERGED = false;
#endif

struct Piece {
  float weight, sum;    // of inverse depths
};

void add(inout Piece piece, float weight, float w) {
  piece.weight += weight;
  piece.sum += weight * w;
}

// The inverse depth that stands for the pixels around one without water.
float nearest_around(ivec2 at, int stride) {
  float w = 0.0;
  for (int v = -1; v <= 1; ++v) {
    for (int u = -1; u <= 1; ++u) w = max(w, inverse_at(at + ivec2(u, v) * stride));
  }
  return w;
}

void pass(ivec2 at) {
  float own = inverse_at(at);
  result_0 = vec4(0.0);
  float middle = own > 0.0 ? own : max(nearest_around(at, 1), nearest_around(at, 2));
  if (middle == 0.0) return;
  float pixel = pixel_at(middle), sigma = max(params.x / pixel, 0.5);
  int stride = int(max(1.0, round(2.5 * sigma / float(TAPS)))); // even: what is counted is water or not, nothing between
  Piece same = Piece(0.0, 0.0), nearer = same, farther = same;
  float all = 0.0;
  for (int v = -TAPS; v <= TAPS; ++v) {
    int across = int(sqrt(float(TAPS * TAPS - v * v)) + 0.5); // the corners of the square weigh nothing
    for (int u = -across; u <= across; ++u) {
      ivec2 offset = ivec2(u, v) * stride;
      if (!in_map(at + offset)) continue; // nothing is known of what lies there
      float w = inverse_at(at + offset), d2 = float(offset.x * offset.x + offset.y * offset.y);
      float weight = exp(-d2 / (2.0 * sigma * sigma));
      float steepest = STEEPEST * pixel * sqrt(d2);
      if (w <= 0.0 && touches(at + offset, middle, params.z + steepest)) continue;
      all += weight;
      float gap = (params.y + steepest) * middle * middle;
      if (w <= 0.0) continue;
      if (w > middle + gap) add(nearer, weight, w);
      else if (w < middle - gap) add(farther, weight, w);
      else add(same, weight, w);
    }
  }
  float water = same.weight + nearer.weight + farther.weight;
  result_0.w = water / all;
  if (2.0 * water < all) return;
  result_0.x = 2.0 * nearer.weight > water ? nearer.sum / nearer.weight
             : 2.0 * farther.weight > water ? farther.sum / farther.weight
             : own > 0.0 && !MERGED ? own
                                    : (same.sum + nearer.sum + farther.sum) / water;
}
#endif
