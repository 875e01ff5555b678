// Rays against solids in their own axes, a function for each SimShape but meshes. Each gives entry and exit of the ray
// o + t·d, entry > exit when it misses, and the outward normal at the entry. An entry before `from` means that the ray
// begins inside.
const vec2 MISSED = vec2(FAR, -FAR);

// The two planes at ±size across one axis.
vec2 slab(float o, float d, float size) {
  float a = (-size - o) / d, b = (size - o) / d;
  if (d == 0.0) return abs(o) < size ? vec2(-FAR, FAR) : MISSED;
  return vec2(min(a, b), max(a, b));
}

// A circle or sphere of radius r around the origin; the foot of the perpendicular keeps it precise.
vec2 ball(vec3 o, vec3 d, float r) {
  float dd = dot(d, d);
  if (dd == 0.0) return dot(o, o) < r * r ? vec2(-FAR, FAR) : MISSED;
  float middle = -dot(o, d) / dd;
  vec3 foot = o + d * middle;
  float h2 = (r * r - dot(foot, foot)) / dd;
  return h2 > 0.0 ? vec2(middle - sqrt(h2), middle + sqrt(h2)) : MISSED;
}

vec2 box(vec3 size, vec3 o, vec3 d, out vec3 normal) {
  vec2 x = slab(o.x, d.x, size.x), y = slab(o.y, d.y, size.y), z = slab(o.z, d.z, size.z);
  float enter = max(x.x, max(y.x, z.x));
  normal = enter == x.x ? vec3(-sign(d.x), 0, 0) : enter == y.x ? vec3(0, -sign(d.y), 0) : vec3(0, 0, -sign(d.z));
  return vec2(enter, min(x.y, min(y.y, z.y)));
}

vec2 meet_box(Body body, vec3 o, vec3 d, float from, out vec3 normal) {
  return box(body.half_size.xyz, o, d, normal);
}

vec2 meet_sphere(Body body, vec3 o, vec3 d, float from, out vec3 normal) {
  vec2 t = ball(o, d, body.half_size.x);
  normal = (o + d * t.x) / body.half_size.x;
  return t;
}

vec2 meet_cylinder(Body body, vec3 o, vec3 d, float from, out vec3 normal) {
  vec2 y = slab(o.y, d.y, body.half_size.y);
  vec2 t = ball(vec3(o.x, 0.0, o.z), vec3(d.x, 0.0, d.z), body.half_size.x);
  vec3 p = o + d * t.x;
  normal = y.x > t.x ? vec3(0.0, -sign(d.y), 0.0) : vec3(p.x, 0.0, p.z) / body.half_size.x;
  return vec2(max(t.x, y.x), min(t.y, y.y));
}

// Two balls and the cylinder between them: what they make is convex, so the first entry is the whole's.
vec2 meet_capsule(Body body, vec3 o, vec3 d, float from, out vec3 normal) {
  float r = body.half_size.x, h = body.half_size.w;
  vec2 side = ball(vec3(o.x, 0.0, o.z), vec3(d.x, 0.0, d.z), r), y = slab(o.y, d.y, h);
  vec2 t = vec2(max(side.x, y.x), min(side.y, y.y));
  if (t.x > t.y) t = MISSED;
  vec2 top = ball(o - vec3(0.0, h, 0.0), d, r), bottom = ball(o + vec3(0.0, h, 0.0), d, r);
  t = vec2(min(t.x, min(top.x, bottom.x)), max(t.y, max(top.y, bottom.y)));
  vec3 p = o + d * t.x;
  normal = (p - vec3(0.0, clamp(p.y, -h, h), 0.0)) / r;
  return t;
}

// In units of one step, u along the flight and v upwards, the solid is v <= floor(u) + 1. Nothing of it lies above the
// line v = u + 1 through the noses, everything below v = u is inside, and between the two a ray that meets the flight
// does so before it has left the step over which it crossed the upper line. So one step is looked at, however many there
// are, with its neighbours, because a nose itself may be rounded to either side.
vec2 meet_stairs(Body body, vec3 o, vec3 d, float from, out vec3 normal) {
  vec3 size = body.half_size.xyz;
  float steps = body.half_size.w;
  vec2 around = box(size, o, d, normal);
  float start = max(around.x, from);
  vec2 per_metre = 0.5 * steps / size.xy;
  vec2 at = clamp((o.xy + d.xy * start + size.xy) * per_metre, 0.0, steps), pace = d.xy * per_metre;
  if (start > around.y || at.y <= min(floor(at.x), steps - 1.0) + 1.0) return around; // missed, or in through the box's side

  float above = max(at.y - at.x - 1.0, 0.0), closing = pace.x - pace.y;
  if (above > 0.0 && closing <= 0.0) return MISSED;
  float step_below = floor(at.x + (above > 0.0 ? pace.x * above / closing : 0.0));
  const float ROUNDING = 1e-3; // steps; closes the cracks between treads and risers
  float best = FAR;
  for (float k = step_below - 1.0; k < step_below + 2.5; ++k) {
    float to_tread = (k + 1.0 - at.y) / pace.y, to_riser = (k - at.x) / pace.x;
    float u = at.x + pace.x * to_tread - k, v = at.y + pace.y * to_riser - k;
    if (pace.y < 0.0 && to_tread >= 0.0 && to_tread < best && abs(u - 0.5) < 0.5 + ROUNDING) {
      best = to_tread;
      normal = vec3(0.0, 1.0, 0.0);
    }
    if (pace.x > 0.0 && to_riser >= 0.0 && to_riser < best && abs(v - 0.5) < 0.5 + ROUNDING) {
      best = to_riser;
      normal = vec3(-1.0, 0.0, 0.0);
    }
  }
  return vec2(start + best, around.y);
}

// That of the one SHAPE of a program for each.
#ifdef SHAPE
#if SHAPE == 0
#define MEET meet_box
#elif SHAPE == 1
#define MEET meet_sphere
#elif SHAPE == 2
#define MEET meet_cylinder
#elif SHAPE == 3
#define MEET meet_capsule
#elif SHAPE == 4
#define MEET meet_stairs
#endif
#endif
