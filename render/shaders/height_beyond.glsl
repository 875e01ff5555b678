// The height field, also beyond the walls of the container, where its waves are their mirror image on the plane through the water:
// what lights the floor at a wall has come in there. `place`, `slope`: height_place and height_slope of pool.glsl; `walls`:
// caustic_walls.
layout(binding = 3) uniform sampler2D height_surface; // height, m; share of water; slopes along x and z

vec4 surface_beyond(vec2 xz, vec4 place, vec4 slope, vec4 walls) {
  vec2 wanted = xz;
  vec2 from = xz - walls.xy;
  float far = length(from), turns = mod(far, max(2.0 * walls.z, 1e-9));
  bool round_mirrored = walls.z > 0.0 && turns > walls.z;
  if (walls.z > 0.0 && far > walls.z) xz = walls.xy + from * (min(turns, 2.0 * walls.z - turns) / far);

  vec2 rim = 0.5 / vec2(textureSize(height_surface, 0)), across = max(1.0 - 2.0 * rim, 1e-6);
  vec2 at = mod(xz * place.xy + place.zw - rim, 2.0 * across);
  bvec2 mirrored = greaterThan(at, across);
  vec2 image = rim + min(at, 2.0 * across - at);
  vec4 surface = textureLod(height_surface, image, 0.0);
  surface.x += dot(slope.xy, wanted - (image - place.zw) / place.xy);
  surface.zw -= slope.xy;
  surface.zw = mix(surface.zw, -surface.zw, vec2(mirrored));
  if (round_mirrored) surface.zw -= from * (2.0 * dot(surface.zw, from) / (far * far));
  surface.zw += slope.xy;
  return surface;
}
