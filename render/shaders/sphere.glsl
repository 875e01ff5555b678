// Where a sphere lies on the screen: Mara & McGuire, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D
// Sphere", 2013. c is the centre in view space, r the radius.

// Tangents of the directions in which the sphere begins and ends, as seen from the eye along one axis:
// x is the centre's coordinate on that axis, d its depth.
vec2 tangents(float x, float d, float r) {
  float root = r * sqrt(x * x + d * d - r * r);
  return vec2(x * d - root, x * d + root) / (d * d - r * r);
}

// Wholly beyond one of the four sides of the view, or nothing of it in front of the eye?
bool outside(vec3 c, float r) {
  vec2 side = (abs(c.xy) + c.z * lens.xy) * inversesqrt(1.0 + lens.xy * lens.xy);
  return any(greaterThan(side, vec2(r))) || -c.z + r < eye.w;
}

// Out of view, behind the eye or around it?
bool hidden(vec3 c, float r) {
  return outside(c, r) || dot(c, c) < r * r;
}

// Lowest and highest x / depth and y / depth, as low.xy, high.xy, cut at the sides of the view: all of it for the few
// spheres that reach behind the eye.
vec4 bounds_of(vec3 c, float r) {
  if (-c.z <= r * 1.001) return vec4(-lens.xy, lens.xy);
  vec2 across = tangents(c.x, -c.z, r), up = tangents(c.y, -c.z, r);
  return vec4(max(vec2(across.x, up.x), -lens.xy), min(vec2(across.y, up.y), lens.xy));
}
