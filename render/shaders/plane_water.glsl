// What a plane of water shows: Cords 2007, section 2.1. Include it after frame.glsl and pool.glsl.
float height_over(vec4 plane, vec3 p) {
  return dot(plane.xyz, p) + plane.w;
}

// Place in the picture of a point, in [-1, 1]; far out when it is behind the eye.
vec2 place_of(vec3 p) {
  vec3 v = to_view(p);
  return v.xy / (max(-v.z, 1e-6) * lens.xy);
}

// Where light from a point below the plane leaves the water for the eye (Snell): the root of the difference of the optical
// sines along the line between the two feet, which grows with the way.
vec3 refraction_point(vec4 plane, vec3 below, float index) {
  float above = height_over(plane, eye.xyz), depth = -height_over(plane, below);
  vec3 foot = eye.xyz - plane.xyz * above, to = below + plane.xyz * max(depth, 0.0);
  float far = distance(foot, to), x = far * above / (above + max(depth, 0.0) / index);
  if (depth <= 0.0 || above <= 0.0) return below + plane.xyz * depth;
  for (int i = 0; i < 5; ++i) {
    float y = far - x, slope = above * above + x * x, slope_below = depth * depth + y * y;
    float f = x * inversesqrt(slope) - index * y * inversesqrt(slope_below);
    float df = above * above * inversesqrt(slope) / slope + index * depth * depth * inversesqrt(slope_below) / slope_below;
    x = clamp(x - f / df, 0.0, far);
  }
  return far > 0.0 ? mix(foot, to, x / far) : to;
}

vec3 mirrored(vec4 plane, vec3 p) {
  return p - 2.0 * height_over(plane, p) * plane.xyz;
}
