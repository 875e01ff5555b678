// Light along a ray in the water. Include it after scene.glsl, scene_light.glsl, container.glsl, height_map.glsl and fresnel.glsl.

// How much of the sun falls on a way of so many metres in the water: the mean of where it begins, at the surface, and of where it ends.
float lit_along(vec3 p, vec3 way, float metres) {
  return 0.5 * (sun_past_solids(p) + caustic_past_solids(p + way * metres, vec3(0.0)));
}

// What is left of light on t metres of water, and what the water itself sends back on that way; `share` of it is to be seen, and `lit`
// of the sun falls on it.
vec3 through_water(vec3 light, float t, float share, float lit) {
  vec3 extinction = max(absorption.rgb + scattering.rgb, 1e-6), left = exp(-extinction * t);
  vec3 source = lit * sun_colour.rgb * (0.09 + 0.09 * max(sun_direction.y, 0.0)) + sky_average(vec3(0.0, 1.0, 0.0)) * 0.9;
  return light * left + share * scattering.rgb / extinction * (1.0 - left) * source;
}

#ifdef ROOF
// Where a ray that is in the water meets its surface from below; FAR: nowhere before `end`. Marching, then the secant method.
float surface_ahead(vec3 p, vec3 way, float end) {
  const int STEPS = 12;
  float top = way.y > 0.0 ? (height_range.y - p.y) / way.y : end;
  end = min(end, max(top, 0.0) * 1.001 + height_range.z);
  float before = 0.0, at_before = -1e-4;
  bool may_meet = way.y > 0.0 || p.y > height_range.x; // below all waves and going down it does not
  for (int i = 1; i <= STEPS && may_meet; ++i) {
    float t = end * float(i) / float(STEPS);
    vec3 there = p + way * t;
    float over = there.y - water_surface(there.xz).x;
    if (over > 0.0) {
      float from = before, f = min(at_before, -1e-5);
      for (int k = 0; k < 3; ++k) {
        float middle = mix(from, t, f / (f - over));
        vec3 there_too = p + way * middle;
        float g = there_too.y - water_surface(there_too.xz).x;
        if (g > 0.0) { t = middle; over = g; } else { from = middle; f = min(g, -1e-5); }
      }
      return mix(from, t, f / (f - over));
    }
    before = t;
    at_before = over;
  }
  return FAR;
}
#endif

// What a ray in the water ends at: a solid, or, out through a wall or (ROOF) the surface, the scene out there. Where more of it is
// mirrored than comes out, it is mirrored: one way is followed for all of it. `path`: metres from the eye; `metres`: of water.
vec3 light_in_water(vec3 p, vec3 way, float path, out float metres) {
  const int LEGS = 4;
  float index = optics.x;
  bool wet = true;
  metres = 0.0;
  vec3 light = vec3(0.0);
  for (int i = 0; i < LEGS; ++i) {
    Meeting meeting = meet_scene(p, way);
    float end = wet ? room_from(p, way).y + 1e-4 * container_max.w : FAR, roof = FAR;
#ifdef ROOF
    if (wet) roof = surface_ahead(p, way, min(min(meeting.t, end), 4.0 * container_max.w));
#endif
    float t = max(min(meeting.t, min(end, roof)), 0.0); // water may be, absurdly, beside its container
    metres += wet ? t : 0.0;
    light = light_from(p, way, meeting, pixel_at(path + metres + (wet ? 0.0 : min(meeting.t, 1e4))));
    if (!wet) light = past_edges(p, way, meeting.t, path + metres, light);
    if (!wet || meeting.t <= min(end, roof)) break;
    p += way * t;
    vec3 normal = wall_normal(p);
#ifdef ROOF
    if (roof < end) normal = water_normal(water_surface(p.xz));
#endif
    normal = dot(normal, way) > 0.0 ? normal : -normal;
    vec3 out_there = refract(way, -normal, index);
    wet = fresnel(dot(way, normal), 1.0 / index) > 0.5;
    way = wet ? reflect(way, normal) : out_there;
    p += way * (1e-4 * container_max.w);
  }
  return light;
}
