// Up to four refractions: Imai, Kanamori, Mitani, "Real-Time Screen-Space Liquid Rendering with Complex Refractions",
// 2016, sections 4.4 and 4.5. A ray enters the nearest water, leaves it, enters the next and leaves that; at each surface
// what is mirrored sees the scene (Eqs. 6 to 8), and on its way through water light is absorbed (Eq. 9).
//
// Surfaces of aggregated water are depth maps in which a ray is followed by marching and the secant method. Splashes are
// balls: their maps hold depth and the way from the centre, so that a ray meets them exactly, also where the map shows only
// the far side. Overlapping bodies are one: a way out that lies in other water is none.
#include "frame.glsl"
#define TILES 32
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 particle;        // radius, m; -; length of a march in the air, m; distance to a solid below which water touches it, m
  ivec4 ends[2];        // of the bodies of each shape
  vec4 grid;            // of occupancy: origin, edge of a cell; m
  ivec4 cells;
};
#include "occupancy.glsl"
#define body_end int[6](ends[0].x, ends[0].y, ends[0].z, ends[0].w, ends[1].x, ends[1].y)
layout(binding = 8) uniform sampler2D background; // linear light, depth
#include "scene.glsl"
#include "scene_light.glsl"

layout(binding = 0) uniform sampler2D water;      // aggregated: inverse depths of front and back, smoothed
layout(binding = 1) uniform sampler2D water_front; // normal, depth
layout(binding = 2) uniform sampler2D water_back;
layout(binding = 3) uniform sampler2D ball_front; // of splashes: from the centre to the surface (m), depth
layout(binding = 4) uniform sampler2D ball_back;
#ifdef COLOURED
layout(binding = 9) uniform sampler2D colours;    // of the nearest particle
#endif
layout(location = 0) out vec4 result;
layout(location = 1) out float order;  // 3 · first body + second body - 2: 1 … 3 after splashes, 4 … 6 after aggregated
layout(location = 2) out vec4 seen;    // normal and depth of the first surface

const int AIR = 0, SPLASH = 1, AGGREGATED = 2;

// ---- Maps ---------------------------------------------------------------------------------------------------------

vec2 pixel_of(vec3 p) {
  return clamp((p.xy / (-p.z * lens.xy) * 0.5 + 0.5) * lens.zw, vec2(0.5), lens.zw - 0.5);
}

vec3 ray_through(vec2 pixel) {
  return view_ray(pixel / lens.zw * 2.0 - 1.0);
}

// Depths of front and back; 0 where there is none.
vec2 water_at(ivec2 pixel) {
  vec2 w = texelFetch(water, pixel, 0).xy;
  return w.x > 0.0 ? 1.0 / w : vec2(0.0);
}

vec2 water_at(vec3 p) {
  return water_at(ivec2(pixel_of(p)));
}

// Maps hold normals in world axes.
vec3 turned(vec3 normal) {
  return mat3(world_to_view) * normal;
}

// How far p lies outside the aggregated water along the view axis; negative inside.
float outside(vec3 p, vec2 w) {
  return w.y > 0.0 ? max(-p.z - w.y, w.x + p.z) : FAR;
}

// The same of an eye in the water, which often looks along the surface: there depths change by more than radii from pixel to
// pixel, and the distance from the pixel's plane tells what the depth does not. Behind the eye there is more water.
float outside(vec3 p) {
#ifdef SUBMERGED
  if (-p.z < eye.w) return -particle.x;
  ivec2 pixel = ivec2(pixel_of(p));
  vec4 s = texelFetch(water_back, pixel, 0);
  return s.w > 0.0 ? dot(p - ray_through(vec2(pixel) + 0.5) * s.w, turned(s.xyz)) : FAR;
#else
  return outside(p, water_at(p));
#endif
}

// Centre and radius of the splash that a map shows at a pixel; radius 0 where there is none.
vec4 ball_at(vec4 surface, ivec2 pixel) {
  vec3 from_centre = turned(surface.xyz);
  return vec4(ray_through(vec2(pixel) + 0.5) * surface.w - from_centre, length(from_centre));
}

// Entry and exit of the unit direction d from p; entry > exit when it misses.
vec2 meet_ball(vec3 p, vec3 d, vec4 ball) {
  float middle = dot(ball.xyz - p, d);
  vec3 foot = p + d * middle - ball.xyz;
  float h2 = ball.w * ball.w - dot(foot, foot);
  float h = sqrt(max(h2, 0.0));
  return h2 > 0.0 ? vec2(middle - h, middle + h) : vec2(FAR, -FAR);
}

// ---- Where a ray leaves and enters ------------------------------------------------------------------------------------

struct Surface {
  float t;              // m along the ray
  vec3 normal;          // outward, in view space; zero where the way through the surface cannot be known
  int body;             // whose it is; AIR: none
  vec4 ball;            // centre and radius, if it is a splash's
};

Surface none(float t) {
  return Surface(t, vec3(0.0), AIR, vec4(0.0));
}

Surface of_ball(vec3 p, vec3 d, float t, vec4 ball) {
  return Surface(t, (p + d * t - ball.xyz) / ball.w, SPLASH, ball);
}

Surface of_water(float t, vec3 normal) {
  return Surface(t, normal, AGGREGATED, vec4(0.0));
}

// The surface of aggregated water near p, where the ray crosses it; read between pixels.
Surface crossing(vec3 p, vec3 d, float t) {
  vec3 at = p + d * t;
  vec2 pixel = pixel_of(at);
  vec2 w = water_at(ivec2(pixel));
  bool through_back = abs(-at.z - w.y) < abs(-at.z - w.x);
  vec4 s = through_back ? texelFetch(water_back, ivec2(pixel), 0) : texelFetch(water_front, ivec2(pixel), 0);
  vec3 smooth_normal = through_back ? textureLod(water_back, pixel / lens.zw, 0.0).xyz
                                    : textureLod(water_front, pixel / lens.zw, 0.0).xyz;
  // The pixel's plane instead of its depth.
  vec3 corner = ray_through(floor(pixel) + 0.5) * s.w;
  vec3 n = turned(s.xyz);
  if (w.y <= 0.0 || abs(dot(corner - at, n)) > 2.0 * particle.x) return of_water(t, vec3(0.0));
  float slope = dot(d, n);
  float step_on = dot(corner - at, n) / (abs(slope) > 0.05 ? slope : 0.05);
  // Not across a crease.
  vec3 normal = dot(smooth_normal, s.xyz) > 0.98 ? smooth_normal : s.xyz;
  return of_water(max(t + clamp(step_on, -particle.x, particle.x), 0.0), normalize(turned(normal)));
}

const int MARCH = 6, SECANTS = 5, LEAVES = REFRACTIONS > 1 ? REFRACTIONS + 1 : 1;

// Narrow [inside, outside] down to the surface: the secant method kept between its ends, where an end that stays has its
// value halved (the Illinois algorithm: Dowell & Jarratt, "A modified regula falsi method", 1971). Where there is no water
// the interval is halved.
float narrow(vec3 p, vec3 d, vec2 t, vec2 f) {
  f.y = min(f.y, -f.x);
  for (int i = 0; i < SECANTS; ++i) {
    float middle = mix(t.x, t.y, clamp(f.x / (f.x - f.y), 0.05, 0.95));
    vec3 at = p + d * middle;
    float g = outside(at);
    bool in_it = g < 0.0;
    t = in_it ? vec2(middle, t.y) : vec2(t.x, middle);
    f = in_it ? vec2(g, 0.5 * f.y) : vec2(0.5 * f.x, g);
    f.y = min(f.y, -f.x);
  }
  return mix(t.x, t.y, f.x / (f.x - f.y));
}

// Where the ray leaves the scene, or its container, whose top is open; the water ends there at the latest.
Surface walls(vec3 p, vec3 d) {
  vec3 origin = eye.xyz + to_world(p), way = to_world(d);
  way = mix(way, vec3(1e-9), lessThan(abs(way), vec3(1e-9)));
  vec3 ends = max((container_min.xyz - origin) / way, (container_max.xyz - origin) / way);
#ifdef CLIP_BOX
  if (way.y > 0.0) ends.y = FAR;
#endif
  float t = max(min(ends.x, min(ends.y, ends.z)), 0.0);
#ifdef CLIP_BOX
  vec3 axis = vec3(lessThanEqual(ends, ends.yzx)) * vec3(lessThanEqual(ends, ends.zxy));
  return of_water(t, mat3(world_to_view) * normalize(axis * sign(way)));
#else
  return of_water(t, vec3(0.0));
#endif
}

// Out of aggregated water, from a point in it or on its surface.
Surface leave_water(vec3 p, vec3 d) {
  Surface wall = walls(p, d);
  vec2 w = water_at(p);
  // Along the ray to the depth of the surface ahead as this pixel has it.
  float guess = d.z < 0.0 ? (w.y + p.z) / -d.z : (-p.z - w.x) / d.z;
  // From the surface itself, where a ray has been mirrored, it tells nothing: then to the walls.
  if (guess < particle.x) guess = wall.t;
  guess = clamp(guess, particle.x, container_max.w);
  vec2 t = vec2(0.0, guess), f = vec2(-particle.x, particle.x);
  bool found = false;
  const float AHEAD[MARCH] = float[MARCH](0.3, 0.65, 1.03, 1.6, 2.6, 5.0);
  for (int i = 0; i < MARCH; ++i) {
    float next = guess * AHEAD[i];
#ifdef CLIP_BOX
    next = min(next, wall.t);
#endif
    vec3 at = p + d * next;
    float g = outside(at);
    if (!found && g > 0.0) {
      found = true;
      t.y = next;
      f.y = g;
    } else if (!found) {
      t.x = next;
      f.x = g;
    }
  }
#ifdef CLIP_BOX
  if (!found) return wall;
#else
  if (!found) return of_water(t.x, vec3(0.0));
#endif
  Surface found_at = crossing(p, d, narrow(p, d, t, f));
#ifdef CLIP_BOX
  if (found_at.t > wall.t - 0.25 * particle.x) return wall;
#endif
  return found_at;
}

// Into the next water ahead of p, nearer than `end`.
Surface enter(vec3 p, vec3 d, float end) {
  Surface next = none(end);
  vec2 w = water_at(p);
  float to_front = d.z < 0.0 && w.x > -p.z ? (w.x + p.z) / -d.z + particle.x : 0.0;
  vec2 t = vec2(0.0, end), f = vec2(particle.x, -particle.x);
  bool found = false;
  for (int i = 0; i <= MARCH; ++i) {
    float share = float(i) / float(MARCH);
    float ahead = i == 0 ? min(to_front, end) : mix(min(to_front, end), end, share * share);
    vec3 at = p + d * ahead;
    ivec2 pixel = ivec2(pixel_of(at));
#ifndef SUBMERGED // whose maps know no other water
    float g = outside(at, water_at(pixel));
    if (!found && ahead > particle.x && g < -0.25 * particle.x) {
      found = true;
      t.y = ahead;
      f.y = g;
    } else if (!found) {
      t.x = ahead;
      f.x = min(max(g, 1e-6), particle.x);
    }
#endif
#ifdef SPLASHES
    vec4 near = ball_at(texelFetch(ball_front, pixel, 0), pixel), far = ball_at(texelFetch(ball_back, pixel, 0), pixel);
    vec2 of_near = meet_ball(p, d, near), of_far = meet_ball(p, d, far);
    if (of_near.x <= of_near.y && of_near.x > 0.01 * near.w && of_near.x < next.t) next = of_ball(p, d, of_near.x, near);
    if (of_far.x <= of_far.y && of_far.x > 0.01 * far.w && of_far.x < next.t) next = of_ball(p, d, of_far.x, far);
#endif
  }
  if (found && t.x < next.t) {
    // From outside to inside: the same with the ends the other way round.
    float at = narrow(p, d, t.yx, f.yx);
    if (at < next.t) next = crossing(p, d, at);
  }
  return next;
}

// Out of the body that the ray is in, and on through whatever overlaps it. `ball`: the splash that it is in.
Surface leave(vec3 p, vec3 d, vec4 ball, inout int body) {
  Surface out_of = none(0.0);
#ifdef SPLASHES
  if (body == SPLASH) {
    float t = max(2.0 * dot(d, ball.xyz - p), 0.0);
    vec3 at = p + d * t;
    out_of = of_ball(p, d, t, ball);
    ivec2 pixel = ivec2(pixel_of(at));
    vec4 other = ball_at(texelFetch(ball_back, pixel, 0), pixel);
    if (distance(other.xyz, at) < 0.99 * other.w) {
      out_of = of_ball(p, d, meet_ball(p, d, other).y, other);
    }
    at = p + d * out_of.t;
    if (outside(at) < -0.25 * particle.x) body = AGGREGATED;
  }
#endif
  if (body == AGGREGATED) {
    float start = out_of.t;
    out_of = leave_water(p + d * start, d);
    out_of.t += start;
  }
  return out_of;
}

// ---- Light ------------------------------------------------------------------------------------------------------------

// A ray on its way from the eye.
struct Ray {
  vec3 p, d;            // where it is, and its unit direction, in view space
  float path;           // metres that it has come
  vec3 through;         // share of the light from there that reaches the eye
  int body;             // what it is in
  vec4 ball;            // the splash that it is in
};

// What the scene sends along a direction in the air.
vec3 scene_light_from(vec3 p, vec3 d, float path) {
  return scene_light(eye.xyz + to_world(p), to_world(d), path);
}

Surface first_surface(vec3 ray, float behind) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 w = water_at(pixel);
  Surface first = none(FAR);
  if (w.y > 0.0) first = of_water(w.x, turned(texelFetch(water_front, pixel, 0).xyz));
#ifdef SPLASHES
  vec4 nearest = texelFetch(ball_front, pixel, 0);
  if (nearest.w > 0.0 && nearest.w < first.t) first = of_ball(vec3(0.0), ray, nearest.w, ball_at(nearest, pixel));
#endif
  if (behind > 0.0 && behind < first.t) first.body = AIR;
  return first;
}

// Eq. 6: what is mirrored at a surface, and on into the water.
vec3 into(inout Ray ray, Surface surface, float index) {
  float mirror = schlick(-dot(ray.d, surface.normal));
  vec3 mirrored = reflect(ray.d, surface.normal);
  vec3 light = ray.through * mirror * (scene_light_from(ray.p, mirrored, ray.path) +
                                       sun_mirrored(eye.xyz + to_world(ray.p), to_world(mirrored)));
  ray.through *= 1.0 - mirror;
  ray.d = refract(ray.d, surface.normal, 1.0 / index);
  ray.body = surface.body;
  ray.ball = surface.ball;
  return light;
}

// What coloured water lets through on a way of t metres: its colour on the whole, less of it where it is thin.
vec3 tint(float t) {
#ifdef COLOURED
  // Each particle has one colour: some of its neighbours' smooth them.
  vec4 colour = vec4(0.0);
  vec2 reach = 2.0 * particle.x / seen.w / lens.xy * 0.5;
  for (int i = 0; i < 9; ++i) {
    colour += textureLod(colours, gl_FragCoord.xy / lens.zw + reach * vec2(i % 3 - 1, i / 3 - 1), 0.0);
  }
  return mix(vec3(1.0), colour.rgb / max(colour.a, 1e-3), 1.0 - exp(-t / (3.0 * particle.x)));
#else
  return vec3(1.0);
#endif
}

// On by t metres, of which `wet` are water.
void go(inout Ray ray, float t, float wet) {
  ray.through *= exp(-absorption.rgb * wet); // Eq. 9
  ray.path += t;
  ray.p += ray.d * t;
}

// Through the water to its far side, or to a solid that the water touches: then nothing of the ray is left.
vec3 across(inout Ray ray, out Surface far_side) {
  vec3 origin = eye.xyz + to_world(ray.p), way = to_world(ray.d);
  Meeting solid = meet_scene(origin, way);
  far_side = leave(ray.p, ray.d, ray.ball, ray.body);
  // The film of air between them, across whichever of the two it is wider.
  float gap = (solid.t - far_side.t) * max(abs(dot(ray.d, far_side.normal)), abs(dot(way, solid.normal)));
  bool wet = solid.what != NOTHING && far_side.body == AGGREGATED && gap < particle.w;
  bool ends = solid.t < far_side.t || wet;
  float t = ends ? solid.t : far_side.t;
  // Between the front and the back that the maps show there may be air, as between two sheets.
  bool hollow = !ends && far_side.body == AGGREGATED && t > 8.0 * particle.x;
  float path = ray.path;
  go(ray, t, hollow ? wet_way(origin, way, t) : t);
  if (!ends) return vec3(0.0);
  vec3 light = ray.through * past_edges(origin, way, solid.t, path, light_from(origin, way, solid, pixel_at(ray.path)));
  ray.through = vec3(0.0);
  return light;
}

// Eq. 7: out of the water. The paper goes on with what is refracted and takes what is mirrored from the scene; near total
// internal reflection and beyond it that is the smaller part, and the ray goes on in the water instead.
vec3 out_of(inout Ray ray, Surface surface, float index) {
  ray.ball = surface.ball;
  if (surface.normal == vec3(0.0)) { // nothing is known of that surface: straight on
    ray.body = AIR;
    return vec3(0.0);
  }
  vec3 bent = refract(ray.d, -surface.normal, index), mirrored = reflect(ray.d, surface.normal);
  float mirror = bent == vec3(0.0) ? 1.0 : schlick(dot(bent, surface.normal));
  bool stays = mirror > 0.5;
  Ray aside = ray;
  aside.d = stays ? bent : mirrored;
  aside.through *= stays ? 1.0 - mirror : mirror;
  ray.d = stays ? mirrored : bent;
  ray.through *= stays ? mirror : 1.0 - mirror;
  if (!stays) ray.body = AIR;
  if (!stays && surface.body == SPLASH) { // what a ball mirrors within leaves it after one more chord, at the same angle
    float chord = max(2.0 * dot(mirrored, surface.ball.xyz - ray.p), 0.0);
    go(aside, chord, chord);
    aside.d = refract(mirrored, (surface.ball.xyz - aside.p) / surface.ball.w, index);
    aside.through *= 1.0 - mirror;
  }
  return aside.through == vec3(0.0) ? vec3(0.0) : aside.through * scene_light_from(aside.p, aside.d, aside.path);
}

void main() {
  const float INDEX = 1.0 / (1.0 - sun_map.z);
  vec3 towards = view_ray(place);
  float behind = texelFetch(background, ivec2(gl_FragCoord.xy), 0).a;
  Surface surface = first_surface(towards, behind);
  if (surface.body == AIR) discard; // the background shows
  Ray ray = Ray(towards * surface.t, normalize(towards), length(towards) * surface.t, vec3(1.0), surface.body, surface.ball);
  int first = surface.body, second = AIR;
  seen = vec4(to_world(surface.normal), surface.t);
  vec3 light = vec3(0.0);
#ifndef SUBMERGED
  light = into(ray, surface, INDEX);
#endif
  float crossing = 0.0, before = 0.0;
  vec3 mirrored_first = light, coloured = vec3(1.0);
  for (int k = 0; k < LEAVES && ray.body != AIR; ++k) {
    Surface far_side;
    if (k == 0) before = ray.path;
    light += across(ray, far_side);
    crossing = far_side.t;
    if (k == 0) coloured = tint(ray.path - before);
    if (ray.through == vec3(0.0)) break;
#if REFRACTIONS == 1
    ray.body = AIR; // out of the water as if it were air
#else
    if (REFRACTIONS == 3 && second != AIR) {
      ray.body = AIR;
    } else {
      light += out_of(ray, far_side, INDEX);
    }
#endif
#if REFRACTIONS > 2
    if (ray.body == AIR && second == AIR) {
      float end = min(meet_scene(eye.xyz + to_world(ray.p), to_world(ray.d)).t, particle.z);
      surface = enter(ray.p, ray.d, end);
      if (surface.body != AIR) {
        second = surface.body;
        ray.p += ray.d * surface.t;
        ray.path += surface.t;
        light += into(ray, surface, INDEX);
      }
    }
#endif
  }
  // What is caught in the water after all: out after one more crossing as long as the last.
  if (ray.body != AIR) go(ray, crossing, crossing);
  if (ray.through != vec3(0.0)) light += ray.through * scene_light_from(ray.p, ray.d, ray.path);
  result = vec4(mirrored_first + (light - mirrored_first) * coloured, 1.0);
  order = float(3 * first + second - 2);
}
#endif
