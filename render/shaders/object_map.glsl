// Objects as the plane water around them shows them (Cords 2007, sections 2.1 and 2.2), each in a rectangle that holds it.
// REFLECTED: the parts above the plane, mirrored, which are seen from the eye of Eq. 1. Else the parts below it.
//
// Every texel stands for a ray of the picture that meets the plane and is refracted there. EYES 0: the ray goes on as plane
// water refracts it (Figure 2, top). EYES 2: it goes on from the one eye of Eqs. 2 and 3, through where it met the plane, onto
// which that eye projects the object (Figure 2, bottom). EYES 1: the same, the projection stretched around a, along the line
// to where the object's lowest point is really seen, so that it is there (Figure 3).
#include "frame.glsl"
#include "body.glsl"
#include "pool.glsl"
#include "plane_water.glsl"

layout(std430, binding = 5) readonly buffer Objects { int object_of_body[]; };

#ifdef VERTEX_STAGE
flat out ivec2 which;   // body, object
flat out vec4 stretch;      // along which unit direction of the plane; by how much what is seen lies off from what is shown

vec2 map_place(vec2 place) {
  return place * lens.zw / (lens.zw + 2.0 * optics.y);
}

// In shares of the way from a, along the line from there to where the object's lowest point is seen.
vec4 stretch_of(WaterObject object) {
  vec3 shown = object.unscaled_b.xyz - object.a.xyz, seen = object.seen_b.xyz - object.a.xyz;
  float far = dot(seen, seen);
  return far > 1e-12 ? vec4(seen * inversesqrt(far), dot(shown, seen) / far - 1.0) : vec4(0.0);
}

void main() {
  const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));
  int i = gl_VertexID / 6;
  which = ivec2(i, object_of_body[i]);
  gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
  if (which.y < 0) return;
  Body body = bodies[i];
  WaterObject object = objects[which.y];
  stretch = stretch_of(object);
  vec2 low = vec2(1e9), high = vec2(-1e9);
  float in_front = 1e9, lowest = 1e9, highest = -1e9;
  for (int corner = 0; corner < 8; ++corner) {
    vec3 side = vec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1) * 2.0 - 1.0;
    vec3 p = body.position.xyz + rotate(body.rotation, side * body.half_size.xyz);
    float over = height_over(object.plane, p);
    lowest = min(lowest, over);
    highest = max(highest, over);
#ifdef REFLECTED
    vec3 shown = p - object.plane.xyz * (over + max(over, 0.0)); // what is below the plane: its foot
#else
    vec3 shown = refraction_point(object.plane, p, optics.x);
#endif
    vec2 at = place_of(shown);
    low = min(low, at);
    high = max(high, at);
    in_front = min(in_front, -to_view(shown).z);
  }
#ifdef REFLECTED
  if (highest <= 0.0) return;
#else
  if (lowest >= 0.0) return;
#endif
  // Between the corners plane water bends edges outwards; one eye shows them elsewhere.
  vec2 margin = 0.1 * (high - low) + 4.0 / lens.zw;
  low -= margin;
  high += margin;
#if EYES > 0 && !defined(REFLECTED)
  in_front = 0.0;
#endif
  if (in_front < eye.w) {
    low = vec2(-2.0);
    high = vec2(2.0);
  }
  vec2 place = mix(clamp(low, -2.0, 2.0), clamp(high, -2.0, 2.0), CORNERS[gl_VertexID % 6]);
  gl_Position = vec4(map_place(place), 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#include "solids.glsl"
#include "solid_light.glsl"
flat in ivec2 which;
flat in vec4 stretch;
layout(location = 0) out vec4 colour;   // linear light, 1
layout(location = 1) out float way;     // m from the plane along the ray

// The ray that a texel stands for: from the plane on, a unit direction.
bool ray_of_texel(WaterObject object, out vec3 origin, out vec3 direction) {
  vec2 place = ((gl_FragCoord.xy - optics.y) / lens.zw) * 2.0 - 1.0;
  vec3 ray = normalize(to_world(view_ray(place)));
  float over = height_over(object.plane, eye.xyz), down = -dot(object.plane.xyz, ray);
  if (over <= 0.0 || down <= 1e-6) return false;
  origin = eye.xyz + ray * (over / down);
#ifdef REFLECTED
  direction = reflect(ray, object.plane.xyz);
#else
#if EYES == 0
  direction = refract(ray, object.plane.xyz, 1.0 / optics.x);
#else
#if EYES == 1
  origin += stretch.xyz * (dot(origin - object.a.xyz, stretch.xyz) * stretch.w);
#endif
  direction = normalize(origin - object.eye_refracted.xyz);
#endif
#endif
  return true;
}

void main() {
  Body body = bodies[which.x];
  vec3 origin, direction, normal;
  if (!ray_of_texel(objects[which.y], origin, direction)) discard;
  vec4 back = vec4(-body.rotation.xyz, body.rotation.w);
  vec3 o = rotate(back, origin - body.position.xyz), d = rotate(back, direction);
#if SHAPE == 4
  // Not convex: the ray's line may have met it before the plane, and meet it again.
  vec2 t = MEET(body, o, d, 0.0, normal);
  if (t.x <= 0.0) t = MEET(body, o, d, -FAR, normal);
#else
  vec2 t = MEET(body, o, d, -FAR, normal);
#endif
  if (t.x > t.y || t.y <= 0.0) discard;
  // A ray that begins in the object shows the side on which it came in: there the surface only wavers over the waterline.
  colour = vec4(body.colour.rgb * solid_light(origin + direction * t.x, rotate(body.rotation, normal)), 1.0);
  way = max(t.x, 1e-5);
  gl_FragDepth = 1.0 / (1.0 + way);
}
#endif
