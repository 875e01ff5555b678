// The round container: an upright cylinder around the middle of its box, inside as wide as the box's shorter side.
const float INSIDE = 0.96; // radius of the inside, in that of the outside

struct Glass {
  vec2 centre;          // m, x and z
  float radius;         // m, of the outside
  vec2 front;           // angles between which the wall turns its outside to the eye; equal when the eye is inside
};

Glass glass_of_container() {
  Glass glass;
  vec2 size = container_max.xz - container_min.xz, to_eye;
  glass.centre = 0.5 * (container_min.xz + container_max.xz);
  glass.radius = 0.5 * min(size.x, size.y) / INSIDE;
  to_eye = eye.xz - glass.centre;
  float middle = to_eye == vec2(0.0) ? 0.0 : atan(to_eye.y, to_eye.x);
  float reach = acos(min(glass.radius / max(length(to_eye), 1e-30), 1.0));
  glass.front = vec2(middle - reach, middle + reach);
  return glass;
}

vec3 on_wall(Glass glass, float angle, float y) {
  vec2 at = glass.centre + glass.radius * vec2(cos(angle), sin(angle));
  return vec3(at.x, y, at.y);
}
