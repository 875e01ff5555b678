// What rays of the real surface see in the maps of objects: Cords 2007, section 2.2, and the trapezium of section 2.3. Include it
// after plane_water.glsl.
//
// A ray of the paper is looked up by its direction alone (ACCESS_DIRECTION), as if the map were infinitely far away: away from the
// waterline that exaggerates every wave, more so the farther the eye is. Here it is looked up in the point where it passes the
// object, which is then corrected by the way that the map tells there.
layout(binding = 1) uniform sampler2D refracted_colour; // linear light times coverage, coverage
layout(binding = 2) uniform sampler2D refracted_way;    // m from the plane along the ray; 0: none
layout(binding = 10) uniform sampler2D reflected_colour;
layout(binding = 11) uniform sampler2D reflected_way;

struct Seen {
  vec4 light;           // times coverage; coverage
  float t;              // m along the ray
};

// The part of the main axis that lies below the plane, or, for what is mirrored, above it. false: there is none.
bool axis_part(WaterObject object, bool reflected, out vec3 from, out vec3 to) {
  float low = height_over(object.plane, object.low.xyz), high = height_over(object.plane, object.high.xyz);
  vec3 cut = mix(object.low.xyz, object.high.xyz, clamp(low / min(low - high, -1e-6), 0.0, 1.0));
  from = reflected ? cut : object.low.xyz;
  to = reflected ? object.high.xyz : cut;
  return reflected ? high > 0.0 : low < 0.0;
}

// Where a ray passes nearest to a stretch: m along the ray; the distance between them there.
vec2 passing(vec3 p, vec3 way, float end, vec3 from, vec3 to) {
  vec3 u = to - from, w = p - from;
  float b = dot(way, u), c = dot(u, u), d = dot(way, w), e = dot(u, w), area = c - b * b;
  float s = clamp(area > 1e-8 * c ? (e - b * d) / area : 0.5, 0.0, 1.0);
  vec3 on_it = from + u * s;
  float t = clamp(dot(on_it - p, way), 0.0, end);
  return vec2(t, distance(p + way * t, on_it));
}

// How much an object's map counts at a point of the surface: 1 in the trapezium between a line behind the object and the eye, 0
// outside of it (Figure 8).
float in_trapezium(WaterObject object, vec3 m) {
#ifdef TRAPEZIUM
  float half_width = object.high.w;
  vec2 to_eye = eye.xz - object.middle.xz;
  float far = length(to_eye);
  if (far < half_width) return 1.0;
  vec2 along = to_eye / far, from = m.xz - object.middle.xz + along * (1.5 * half_width);
  float s = dot(from, along), aside = abs(from.x * along.y - from.y * along.x);
  float width = half_width * mix(optics.z, optics.w, clamp(s / far, 0.0, 1.0));
  return (1.0 - smoothstep(0.75 * width, width, aside)) * smoothstep(0.0, 0.5 * half_width, s);
#else
  return 1.0;
#endif
}

// The object that a ray passes closest to, in its widths; of those that it meets the nearest. −1: none is closer than NEAR.
#ifdef ACCESS_DIRECTION
const float NEAR = 1e9;
#else
const float NEAR = 2.5; // half widths: a circle around a slanted or long body tells it only roughly
#endif

int object_on(vec3 p, vec3 way, float end, bool reflected, out float t) {
  int best = -1;
  float best_score = NEAR;
  t = 0.0;
  for (int k = 0; k < numbers.x; ++k) {
    WaterObject object = objects[k];
    vec3 from, to;
    if (!axis_part(object, reflected, from, to)) continue;
    vec2 pass = passing(p, way, end, from, to);
    float inside = object.high.w * object.high.w - pass.y * pass.y;
    float score = inside > 0.0 ? pass.x - 1e6 : pass.y / object.high.w;
    if (score >= best_score) continue;
    best_score = score;
    best = k;
    t = max(pass.x - sqrt(max(inside, 0.0)), 0.0);
  }
  return best;
}

vec2 shown_at(WaterObject object, vec3 p, bool reflected) {
  return place_of(reflected ? mirrored(object.plane, p) : refraction_point(object.plane, p, optics.x));
}

// The same for a direction alone: that of the ray from the eye which the plane sends there. Far out when there is none.
vec2 shown_towards(WaterObject object, vec3 way, bool reflected) {
  vec3 ray = reflected ? reflect(way, object.plane.xyz) : -refract(-way, -object.plane.xyz, optics.x);
  return ray == vec3(0.0) ? vec2(9.0) : place_of(eye.xyz + ray);
}

vec2 texel_of(vec2 place) {
  return (place * 0.5 + 0.5) * lens.zw + optics.y;
}

float way_at(vec2 place, bool reflected) {
  ivec2 texel = ivec2(floor(texel_of(place)));
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, textureSize(refracted_way, 0)))) return 0.0;
  return reflected ? texelFetch(reflected_way, texel, 0).r : texelFetch(refracted_way, texel, 0).r;
}

// The point that the map shows there.
vec3 point_in_map(WaterObject object, vec2 place, float way, bool reflected) {
  vec3 ray = normalize(to_world(view_ray(place)));
  vec3 on_plane = eye.xyz + ray * (height_over(object.plane, eye.xyz) / max(-dot(object.plane.xyz, ray), 1e-6));
  return on_plane + way * (reflected ? reflect(ray, object.plane.xyz) : refract(ray, object.plane.xyz, 1.0 / optics.x));
}

Seen see_object(WaterObject object, vec3 p, vec3 way, float end, bool reflected, float t) {
#ifdef ACCESS_DIRECTION
  vec2 place = shown_towards(object, way, reflected);
  t = way_at(place, reflected);
#else
  vec2 place = shown_at(object, p + way * t, reflected);
  float far = way_at(place, reflected);
  t = far > 0.0 ? clamp(dot(point_in_map(object, place, far, reflected) - p, way), 0.0, end) : t;
  place = shown_at(object, p + way * t, reflected);
#endif
  vec2 at = texel_of(place) / vec2(textureSize(refracted_colour, 0));
  vec4 light = reflected ? textureLod(reflected_colour, at, 0.0) : textureLod(refracted_colour, at, 0.0);
  bool outside = any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)));
  return Seen(outside ? vec4(0.0) : light * in_trapezium(object, p), t);
}

Seen see_objects(vec3 p, vec3 way, float end, bool reflected) {
  float t;
  int k = object_on(p, way, end, reflected, t);
  Seen seen = Seen(vec4(0.0), 0.0);
  // A loop of at most one turn: where no pixel of a block is near an object, a software rasteriser leaves it out.
  for (int turn = 0; turn < int(k >= 0); ++turn) seen = see_object(objects[k], p, way, end, reflected, t);
  return seen;
}
