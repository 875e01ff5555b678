// What water mirrors: include it after scene.glsl. Points and unit directions are in world axes.
float schlick(float cosine) {
  float x = 1.0 - clamp(cosine, 0.0, 1.0), x2 = x * x;
  return absorption.a + (1.0 - absorption.a) * x2 * x2 * x;
}

// What the scene sends along a direction in the air, `path` metres from the eye.
vec3 scene_light(vec3 origin, vec3 way, float path) {
  Meeting meeting = meet_scene(origin, way);
  return past_edges(origin, way, meeting.t, path,
                    light_from(origin, way, meeting, pixel_at(path + min(meeting.t, 1e4))));
}

// The sun in the water: its disc, wider and dimmer than it is, of the same irradiance.
vec3 sun_mirrored(vec3 p, vec3 way) {
  const float WIDTH = 500.0;
  float x = max(dot(way, sun_direction.xyz), 0.0);
  vec3 disc = sun_colour.rgb * ((WIDTH + 1.0) / (2.0 * PI)) * pow(x, WIDTH);
  return disc * sun_past_solids(p);
}
