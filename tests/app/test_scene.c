// Scenes: values of every type, defaults, and every kind of message with its line.
#include "scene_helpers.h"

#include <math.h>

#include "render/settings.h"

static const char *const whole = //
    "{\n"
    "  \"version\": 1, \"name\": \"A \\u00e9 \\\"quoted\\\" name\",\n"
    "  \"simulation\": {\"solver\": \"pbf\", \"particle_radius\": 0.02, \"gravity\": [1, -9, 0.5], \"iterations\": 7,\n"
    "    \"duration\": 2.5, \"seed\": 9007199254740991, \"jitter\": 0.25},\n"
    "  \"container\": {\"min\": [-1, 0, -1], \"max\": [1, 2, 1], \"visible\": false},\n"
    "  \"fluid\": [{\"min\": [-1, 0, -1], \"max\": [0, 1, 1], \"velocity\": [1, 2, 3], \"colour\": [0.1, 0.2, 0.3]},\n"
    "    {\"type\": \"block\", \"min\": [0, 0, -1], \"max\": [0.5, 1, 1]}],\n"
    "  \"obstacles\": [\n"
    "    {\"type\": \"box\", \"size\": [0.1, 0.2, 0.3], \"position\": [0.7, 0.1, 0], \"rotation\": [0, 90, 0]},\n"
    "    {\"type\": \"sphere\", \"radius\": 0.1, \"position\": [0.8, 1, 0]},\n"
    "    {\"type\": \"cylinder\", \"radius\": 0.1, \"height\": 0.5, \"position\": [0.8, 1, 0.5], \"motion\": "
    "\"static\"}],\n"
    "  \"camera\": {\"eye\": [0, 1, 4], \"target\": [0, 0.5, 0], \"fov\": 40},\n"
    "  \"light\": {\"direction\": [0, 2, 0], \"sun\": false},\n"
    "  \"environment\": {\"sky\": \"gradient\", \"floor\": \"checker\", \"floor_level\": -0.5, \"checker_odd\": [0, 0, "
    "1]},\n"
    "  \"render\": {\"style\": \"points\", \"tone_map\": \"none\", \"points\": {\"scale\": 1}},\n"
    "  \"events\": [\n"
    "    {\"type\": \"camera\", \"time\": 3, \"eye\": [1, 1, 4], \"target\": [0, 0, 0]},\n"
    "    {\"type\": \"push\", \"time\": 1, \"origin\": [0, 0, 5], \"direction\": [0, 0, -4], \"acceleration\": [0, 0, "
    "-9]},\n"
    "    {\"type\": \"pour\", \"time\": 1, \"min\": [0, 1, 0], \"max\": [0.2, 1.2, 0.2]},\n"
    "    {\"type\": \"tilt\", \"time\": 0.5, \"duration\": 1, \"gravity\": [3, -9, 0]},\n"
    "    {\"type\": \"style\", \"time\": 2, \"name\": \"points\"}]\n"
    "}\n";

static void test_every_type_of_value_arrives(void **state) {
  (void)state;
  Scene scene = load(whole);
  assert_string_equal(scene.name, "A \xc3\xa9 \"quoted\" name");
  assert_int_equal(scene.simulation.solver, SIM_SOLVER_PBF);
  assert_true(scene.simulation.particle_radius == 0.02f);
  assert_true(scene.simulation.gravity[0] == 1 && scene.simulation.gravity[2] == 0.5f);
  assert_int_equal(scene.simulation.iterations, 7);
  assert_true(scene.simulation.duration == 2.5);
  assert_true(scene.simulation.seed == UINT64_C(9007199254740991));
  assert_false(scene.container.visible);
  assert_int_equal(scene.fluid_count, 2);
  assert_true(scene.fluid[0].block.velocity[2] == 3 && scene.fluid[0].block.colour[1] == 0.2f);
  assert_int_equal(scene.environment.sky, RENDER_SKY_GRADIENT);
  assert_int_equal(scene.environment.floor, RENDER_FLOOR_CHECKER);
  assert_true(scene.environment.floor_level == -0.5f);
  assert_int_equal(scene.render.tone_map, RENDER_TONE_NONE);
  assert_string_equal(scene.render.style, "points");
  scene_free(&scene);
}

static void test_events_are_sorted_and_completed(void **state) {
  (void)state;
  Scene scene = load(whole);
  const SceneEventType order[] = {EVENT_TILT, EVENT_PUSH, EVENT_POUR, EVENT_STYLE, EVENT_CAMERA};
  assert_int_equal(scene.events_count, 5);
  for (int i = 0; i < 5; i++) assert_int_equal(scene.events[i].type, order[i]);
  assert_true(scene.events[0].time == 0.5 && scene.events[0].duration == 1);
  assert_true(scene.events[0].tilt.gravity[0] == 3);
  // Directions become unit vectors, a camera without a lens keeps the scene's.
  assert_true(scene.events[1].push.direction[2] == -1);
  assert_true(scene.events[1].push.radius == 0.2f);
  assert_true(scene.events[2].pour.max[1] == 1.2f);
  assert_string_equal(scene.events[3].style.name, "points");
  assert_true(scene.events[4].camera.fov == 40);
  scene_free(&scene);
}

static void test_world_def_holds_the_scene(void **state) {
  (void)state;
  Scene scene = load(whole);
  SimWorldDef def = scene_world_def(&scene);
  assert_int_equal(def.cookie, sim_default_world_def().cookie);
  assert_int_equal(def.block_count, 2);
  assert_true(def.blocks[0].velocity[0] == 1 && def.blocks[1].max[0] == 0.5f);
  assert_int_equal(def.obstacle_count, 3);
  assert_int_equal(def.obstacles[0].body.shape, SIM_BOX);
  assert_true(def.obstacles[0].body.size[2] == 0.3f);
  // A quarter turn about y: sin 45° on y and w, nothing else.
  assert_float_equal(def.obstacles[0].body.rotation[1], 0.70710678f, 1e-6);
  assert_float_equal(def.obstacles[0].body.rotation[3], 0.70710678f, 1e-6);
  assert_true(def.obstacles[0].body.rotation[0] == 0 && def.obstacles[0].body.rotation[2] == 0);
  assert_int_equal(def.obstacles[1].body.shape, SIM_SPHERE);
  assert_true(def.obstacles[1].body.size[0] == 0.2f);
  assert_int_equal(def.obstacles[2].body.shape, SIM_CYLINDER);
  assert_true(def.obstacles[2].body.size[0] == 0.2f && def.obstacles[2].body.size[1] == 0.5f);
  assert_true(def.seed == scene.simulation.seed && def.jitter == 0.25f && def.container.min[0] == -1);
  // 25 x 25 x 50 and 12.5 x 25 x 50 spacings: by volume, as nearly as whole layers do.
  assert_true(fabs((double)scene_particle_count(&scene) - 37.5 * 25 * 50) < 0.005 * 37.5 * 25 * 50);
  scene_free(&scene);
}

// Everything that moves, pours or swallows.
static const char *const moving = //
    "{\"version\": 1, \"simulation\": {\"kinematic_viscosity\": 0.5, \"surface_tension\": 0.25, \"vorticity\": 0.125,\n"
    "  \"max_particles\": 5000, \"reuse\": true, \"colour_diffusion\": 0.75, \"particle_radius\": 0.05},\n"
    "\"container\": {\"shape\": \"glass\", \"min\": [-1, 0, -1], \"max\": [1, 2, 1], \"friction\": 0.5},\n"
    "\"fluid\": [\n"
    "  {\"type\": \"emitter\", \"diameter\": 0.25, \"position\": [0, 1.5, 0], \"direction\": [0, -3, 0]},\n"
    "  {\"type\": \"drop\", \"centre\": [0, 1, 0], \"radius\": 0.25, \"velocity\": [0, -2, 0], \"colour\": [0, 0.5, "
    "1]},\n"
    "  {\"type\": \"block\", \"min\": [-0.5, 0, -0.5], \"max\": [0.5, 0.5, 0.5]},\n"
    "  {\"type\": \"emitter\", \"name\": \"wide\", \"shape\": \"rectangle\", \"size\": [0.5, 0.25], \"position\": "
    "[0.25, 0, 0],\n"
    "   \"direction\": [0, 0, 2], \"speed\": 3, \"start\": 1, \"stop\": 2.5, \"colour\": [1, 0, 0], \"obstacle\": "
    "\"ball\"}],\n"
    "\"sinks\": [{\"min\": [0.5, 0, 0.5], \"max\": [1, 0.5, 1]}],\n"
    "\"obstacles\": [\n"
    "  {\"type\": \"capsule\", \"radius\": 0.125, \"height\": 0.5, \"position\": [0, 1, 0], \"motion\": \"scripted\", "
    "\"friction\": "
    "0.25,\n"
    "   \"keys\": [{\"time\": 1, \"position\": [0, 1, 0]}, {\"time\": 2, \"position\": [1, 1, 0], \"rotation\": [90, "
    "0, 0]}],\n"
    "   \"repeat\": true, \"stroke\": [0, 0.5, 0], \"period\": 4, \"start\": 3},\n"
    "  {\"type\": \"stairs\", \"size\": [1, 0.5, 0.25], \"steps\": 5, \"position\": [0, 0.25, 0]},\n"
    "  {\"type\": \"sphere\", \"name\": \"ball\", \"radius\": 0.25, \"position\": [0, 0.5, 0], \"motion\": "
    "\"draggable\", "
    "\"max_speed\": 2},\n"
    "  {\"type\": \"box\", \"size\": [1, 1, 1], \"position\": [0, 0.5, 0], \"motion\": \"floating\", \"density\": "
    "250}],\n"
    "\"events\": [{\"type\": \"drag\", \"obstacle\": \"ball\", \"position\": [0.5, 0.5, 0]},\n"
    "  {\"type\": \"drag\", \"obstacle\": 2, \"position\": [0, 0.5, 0], \"rotation\": [0, 90, 0]},\n"
    "  {\"type\": \"emitter\", \"emitter\": \"wide\", \"on\": false}, {\"type\": \"emitter\", \"emitter\": 0, \"on\": "
    "true}]}\n";

static void test_world_def_holds_the_method(void **state) {
  (void)state;
  Scene scene = load(moving);
  SimWorldDef def = scene_world_def(&scene);
  assert_true(def.kinematic_viscosity == 0.5f && def.surface_tension == 0.25f && def.vorticity == 0.125f);
  assert_true(def.max_particles == 5000 && def.reuse && def.colour_diffusion == 0.75f);
  assert_int_equal(def.container.shape, SIM_CONTAINER_GLASS);
  assert_true(def.container_friction == 0.5f);
  scene_free(&scene);
  scene = load("{\"version\": 1, \"simulation\": {\"solver\": \"sph\"}}");
  assert_int_equal(scene_world_def(&scene).solver, SIM_SOLVER_SPH);
  scene_free(&scene);
}

/// Turned by the quaternion, `from` must become `to`.
static void assert_turns(const float q[4], const float from[3], const float to[3]) {
  float t[3], out[3];
  for (int k = 0; k < 3; k++) t[k] = 2 * (q[(k + 1) % 3] * from[(k + 2) % 3] - q[(k + 2) % 3] * from[(k + 1) % 3]);
  for (int k = 0; k < 3; k++) {
    out[k] = from[k] + q[3] * t[k] + q[(k + 1) % 3] * t[(k + 2) % 3] - q[(k + 2) % 3] * t[(k + 1) % 3];
    assert_float_equal(out[k], to[k], 1e-6);
  }
}

static void test_world_def_holds_water_of_every_kind(void **state) {
  (void)state;
  Scene scene = load(moving);
  SimWorldDef def = scene_world_def(&scene);
  assert_int_equal(def.block_count, 1);
  assert_true(def.blocks[0].max[1] == 0.5f);
  assert_int_equal(def.drop_count, 1);
  assert_true(def.drops[0].centre[1] == 1 && def.drops[0].radius == 0.25f && def.drops[0].velocity[1] == -2);
  assert_true(def.drops[0].colour[2] == 1);
  assert_int_equal(def.sink_count, 1);
  assert_true(def.sinks[0].min[0] == 0.5f && def.sinks[0].max[1] == 0.5f);
  assert_int_equal(def.emitter_count, 2);
  const SimEmitterDef *tap = &def.emitters[0], *wide = &def.emitters[1];
  assert_true(tap->shape == SIM_EMITTER_DISC && tap->size[0] == 0.25f && tap->speed == 1 && tap->obstacle == -1);
  assert_true(tap->start == 0 && isinf(tap->stop));
  assert_true(wide->shape == SIM_EMITTER_RECTANGLE && wide->size[0] == 0.5f && wide->size[1] == 0.25f);
  assert_true(wide->speed == 3 && wide->start == 1 && wide->stop == 2.5 && wide->colour[0] == 1);
  assert_true(wide->position[0] == 0.25f && wide->obstacle == 2);
  // 10 x 10 x 5 in the block, and the drop by its volume: 4/3 pi 2.5^3.
  assert_true(scene_particle_count(&scene) == 500 + 65);
  scene_free(&scene);
}

static void test_emitters_are_turned_to_their_direction(void **state) {
  (void)state;
  static const float x[3] = {1, 0, 0}, y[3] = {0, 1, 0};
  const struct {
    const char *direction, *up;
    float along[3], first[3];
  } rows[] = {{"[1, 0, 0]", "[0, 1, 0]", {1, 0, 0}, {0, 1, 0}},
              {"[-5, 0, 0]", "[0, 1, 0]", {-1, 0, 0}, {0, 1, 0}},
              {"[0, 0, 2]", "[0, 1, 0]", {0, 0, 1}, {0, 1, 0}},
              {"[0, 0, -1]", "[1, 1, 0]", {0, 0, -1}, {0.70710678f, 0.70710678f, 0}},
              {"[0, -1, 0]", "[0, 0, 7]", {0, -1, 0}, {0, 0, 1}},
              {"[0, -1, 0]", "[0, 1, 0]", {0, -1, 0}, {1, 0, 0}},
              {"[2, 0, 0]", "[1, 0, 0]", {1, 0, 0}, {0, 1, 0}},
              {"[3, -4, 0]", "[0, 1, 0]", {0.6f, -0.8f, 0}, {0.8f, 0.6f, 0}},
              {"[-1, 0, 0]", "[0, -1, 0]", {-1, 0, 0}, {0, -1, 0}},
              {"[0, 1, 0]", "[-1, 0, 0]", {0, 1, 0}, {-1, 0, 0}}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[400];
    snprintf(text, sizeof text,
             "{\"version\": 1, \"fluid\": [{\"type\": \"emitter\", \"diameter\": 0.1, \"position\": [1, 1, 0.5], "
             "\"direction\": %s, \"up\": %s}]}",
             rows[i].direction, rows[i].up);
    Scene scene = load(text);
    const float *q = scene_world_def(&scene).emitters[0].rotation;
    assert_turns(q, x, rows[i].along);
    assert_turns(q, y, rows[i].first);
    scene_free(&scene);
  }
}

static void test_world_def_holds_bodies_and_their_motion(void **state) {
  (void)state;
  Scene scene = load(moving);
  SimWorldDef def = scene_world_def(&scene);
  const SimObstacleDef *capsule = &def.obstacles[0], *stairs = &def.obstacles[1], *ball = &def.obstacles[2];
  assert_int_equal(def.obstacle_count, 4);
  assert_true(capsule->body.shape == SIM_CAPSULE && capsule->body.size[0] == 0.25f && capsule->body.size[1] == 0.5f);
  assert_true(capsule->motion == SIM_SCRIPTED && capsule->friction == 0.25f && capsule->repeat);
  assert_true(capsule->key_count == 2 && capsule->keys[0].time == 1 && capsule->keys[0].rotation[3] == 1);
  assert_true(capsule->keys[1].position[0] == 1);
  assert_float_equal(capsule->keys[1].rotation[0], 0.70710678f, 1e-6);
  assert_true(capsule->stroke[1] == 0.5f && capsule->period == 4 && capsule->start == 3);
  assert_true(stairs->body.shape == SIM_STAIRS && stairs->body.steps == 5 && stairs->body.size[2] == 0.25f);
  assert_true(stairs->motion == SIM_STATIC && stairs->key_count == 0);
  assert_true(ball->motion == SIM_DRAGGABLE && ball->max_speed == 2);
  assert_true(def.obstacles[3].motion == SIM_FLOATING && def.obstacles[3].density == 250);
  scene_free(&scene);
}

static void test_names_find_their_items(void **state) {
  (void)state;
  Scene scene = load(moving);
  assert_int_equal(scene.events[0].drag.obstacle.index, 2);
  assert_int_equal(scene.events[1].drag.obstacle.index, 2);
  assert_int_equal(scene.events[2].emitter.emitter.index, 3); // in the list of fluid
  assert_int_equal(scene_emitter_index(&scene, 3), 1);        // among the world's emitters
  assert_int_equal(scene_emitter_index(&scene, 0), 0);
  assert_int_equal(scene_emitter_index(&scene, 1), -1);
  assert_int_equal(scene_emitter_index(&scene, 9), -1);
  assert_false(scene.events[2].emitter.on);
  scene_free(&scene);
}

static void test_defaults_of_bodies_are_the_simulators(void **state) {
  (void)state;
  Scene scene =
      load("{\"version\": 1, \"obstacles\": [{\"type\": \"box\", \"size\": [1, 1, 1], \"position\": [0, 0, 0]}]}");
  SimObstacleDef should = sim_default_obstacle_def();
  const SimObstacleDef *is = scene_world_def(&scene).obstacles;
  assert_int_equal(is->motion, should.motion);
  assert_true(is->friction == should.friction && is->repeat == should.repeat && is->period == should.period);
  assert_true(is->start == should.start && is->max_speed == should.max_speed && is->density == should.density);
  assert_memory_equal(is->stroke, should.stroke, sizeof is->stroke);
  scene_free(&scene);
}

static void test_render_settings_and_view_hold_the_scene(void **state) {
  (void)state;
  Scene scene = load(whole);
  RenderSettings settings = scene_render_settings(&scene);
  RenderView view = scene_view(&scene);
  assert_int_equal(settings.cookie, render_default_settings().cookie);
  assert_string_equal(settings.style, "points");
  assert_true(!settings.sun && settings.shadow && !settings.container_visible);
  assert_true(settings.floor_level == -0.5f && settings.floor_colour[1][2] == 1);
  assert_int_equal(settings.tone_map, RENDER_TONE_NONE);
  assert_true(settings.points.scale == 1 && settings.sun_direction[1] == 2);
  assert_true(view.eye[2] == 4 && view.target[1] == 0.5f && view.vertical_fov == 40);
  scene_free(&scene);
}

// ---- Defaults -------------------------------------------------------------------------------------------------------

static void test_defaults_are_those_of_the_libraries(void **state) {
  (void)state;
  Scene scene = load("{\"version\": 1}");
  SimWorldDef is = scene_world_def(&scene), should = sim_default_world_def();
  // What the scene adds is put aside; padding was zeroed in neither.
  assert_int_equal(is.block_count, 0);
  assert_int_equal(is.obstacle_count, 0);
  assert_true(is.solver == should.solver && is.particle_radius == should.particle_radius);
  assert_true(is.rest_density == should.rest_density && is.support == should.support);
  assert_memory_equal(is.gravity, should.gravity, sizeof is.gravity);
  assert_true(is.time_step == should.time_step && is.cfl == should.cfl && is.iterations == should.iterations);
  assert_true(is.kinematic_viscosity == should.kinematic_viscosity && is.surface_tension == should.surface_tension);
  assert_true(is.vorticity == should.vorticity && is.colour_diffusion == should.colour_diffusion);
  assert_true(is.max_particles == should.max_particles && is.reuse == should.reuse);
  assert_true(is.container_friction == should.container_friction);
  assert_true(is.drop_count == 0 && is.emitter_count == 0 && is.sink_count == 0);
  assert_true(is.viscosity == should.viscosity && is.relaxation == should.relaxation && is.tensile == should.tensile);
  assert_memory_equal(&is.container, &should.container, sizeof is.container);
  assert_true(is.seed == should.seed && is.jitter == should.jitter && is.threads == should.threads);

  RenderSettings look = scene_render_settings(&scene), best = render_default_settings();
  assert_string_equal(look.style, "refraction"); // the library's own default is the style that needs nothing of a frame
  assert_memory_equal(look.sun_direction, best.sun_direction, sizeof look.sun_direction);
  assert_memory_equal(look.sun_colour, best.sun_colour, sizeof look.sun_colour);
  assert_true(look.sun == best.sun && look.shadow == best.shadow && look.sky == best.sky && look.floor == best.floor);
  assert_memory_equal(look.sky_zenith, best.sky_zenith, sizeof look.sky_zenith);
  assert_memory_equal(look.sky_horizon, best.sky_horizon, sizeof look.sky_horizon);
  assert_true(isnan(look.floor_level) && isnan(best.floor_level));
  assert_true(look.tile_size == best.tile_size && look.container_visible == best.container_visible);
  assert_memory_equal(look.floor_colour, best.floor_colour, sizeof look.floor_colour);
  assert_memory_equal(look.absorption, best.absorption, sizeof look.absorption);
  assert_true(look.refractive_index == best.refractive_index && look.exposure == best.exposure);
  assert_true(look.tone_map == best.tone_map && look.points.scale == best.points.scale);
  const RenderRefraction *a = &look.refraction, *b = &best.refraction;
  assert_true(a->count == b->count && a->scale == b->scale && a->lift == b->lift && a->smoothing == b->smoothing);
  assert_true(a->sigma == b->sigma && a->window == b->window && a->reach == b->reach);
  assert_true(a->iterations == b->iterations && a->view_dependent == b->view_dependent);
  assert_true(a->splashes_apart == b->splashes_apart && a->surface_only == b->surface_only);
  const RenderHeightfield *h = &look.heightfield, *own = &best.heightfield;
#define SAME(field) assert_true(h->field == own->field)
  SAME(smoothing), SAME(drops), SAME(mapped), SAME(eyes), SAME(access), SAME(plane_reach), SAME(pull_reach);
  SAME(group_distance), SAME(trapezium), SAME(trapezium_a), SAME(trapezium_b), SAME(traced_caustics);
  SAME(simple_caustics), SAME(simple_height), SAME(simple_slope), SAME(simple_base), SAME(dispersion);
#undef SAME
  scene_free(&scene);
}

// Every key of the style, with a value that no other key has.
static void test_keys_of_the_height_field_arrive(void **state) {
  (void)state;
  Scene scene =
      load("{\"version\": 1, \"render\": {\"heightfield\": {\"smoothing\": 1.5, \"drops\": false, \"mapped\": false,\n"
           "\"eyes\": \"scaled\", \"access\": \"direction\", \"plane_reach\": 20, \"pull_reach\": 7, "
           "\"group_distance\": 5,\n"
           "\"trapezium\": false, \"trapezium_a\": 4, \"trapezium_b\": 2, \"traced_caustics\": false,\n"
           "\"simple_caustics\": true, \"simple_height\": 0.25, \"simple_slope\": -3, \"simple_base\": 0.75,\n"
           "\"dispersion\": 0.125}}}");
  const RenderHeightfield h = scene_render_settings(&scene).heightfield;
  assert_true(h.smoothing == 1.5f && !h.drops && !h.mapped && h.eyes == RENDER_EYES_SCALED);
  assert_true(h.access == RENDER_ACCESS_DIRECTION && h.plane_reach == 20 && h.pull_reach == 7);
  assert_true(h.group_distance == 5 && !h.trapezium && h.trapezium_a == 4 && h.trapezium_b == 2);
  assert_true(!h.traced_caustics && h.simple_caustics && h.simple_height == 0.25f && h.simple_slope == -3);
  assert_true(h.simple_base == 0.75f && h.dispersion == 0.125f);
  scene_free(&scene);
  refused("{\"version\": 1, \"render\": {\"heightfield\": {\"eyes\": \"eech\"}}}",
          "t.json:1: render.heightfield.eyes: must be one of each, scaled, one, got \"eech\", did you mean \"each\"?");
  refused("{\"version\": 1, \"render\": {\"heightfield\": {\"acess\": \"point\"}}}",
          "t.json:1: render.heightfield.acess: unknown key, did you mean \"access\"?");
}

/// The object with these keys, "render.heightfield".
static const SceneObject *object_of(const char *keys) {
  char parts[64];
  snprintf(parts, sizeof parts, "%s", keys);
  const SceneObject *object = &scene_top;
  for (char *rest = parts, *key; (key = strtok_r(rest, ".", &rest));) object = scene_field_find(object, key)->object;
  return object;
}

static void test_names_in_the_table_stand_for_the_right_values(void **state) {
  (void)state;
  const struct {
    const char *object, *key, *name;
    int value;
  } rows[] = {{"simulation", "solver", "pbf", SOLVER_PBF},
              {"simulation", "solver", "sph", SOLVER_SPH},
              {"container", "shape", "box", CONTAINER_BOX},
              {"container", "shape", "glass", CONTAINER_GLASS},
              {"fluid", "type", "block", FLUID_BLOCK},
              {"fluid", "type", "drop", FLUID_DROP},
              {"fluid", "type", "emitter", FLUID_EMITTER},
              {"fluid", "type", "ripple", FLUID_RIPPLE},
              {"fluid", "shape", "disc", EMITTER_DISC},
              {"fluid", "shape", "rectangle", EMITTER_RECTANGLE},
              {"obstacles", "type", "box", OBSTACLE_BOX},
              {"obstacles", "type", "sphere", OBSTACLE_SPHERE},
              {"obstacles", "type", "cylinder", OBSTACLE_CYLINDER},
              {"obstacles", "type", "capsule", OBSTACLE_CAPSULE},
              {"obstacles", "type", "stairs", OBSTACLE_STAIRS},
              {"obstacles", "type", "mesh", OBSTACLE_MESH},
              {"obstacles", "motion", "static", MOTION_STATIC},
              {"obstacles", "motion", "scripted", MOTION_SCRIPTED},
              {"obstacles", "motion", "draggable", MOTION_DRAGGABLE},
              {"obstacles", "motion", "floating", MOTION_FLOATING},
              {"environment", "sky", "clear", RENDER_SKY_CLEAR},
              {"environment", "sky", "gradient", RENDER_SKY_GRADIENT},
              {"environment", "floor", "tiles", RENDER_FLOOR_TILES},
              {"environment", "floor", "checker", RENDER_FLOOR_CHECKER},
              {"environment", "floor", "none", RENDER_FLOOR_NONE},
              {"render", "tone_map", "none", RENDER_TONE_NONE},
              {"render", "tone_map", "filmic", RENDER_TONE_FILMIC},
              {"render.heightfield", "eyes", "each", RENDER_EYES_EACH},
              {"render.heightfield", "eyes", "scaled", RENDER_EYES_SCALED},
              {"render.heightfield", "eyes", "one", RENDER_EYES_ONE},
              {"render.heightfield", "access", "point", RENDER_ACCESS_POINT},
              {"render.heightfield", "access", "direction", RENDER_ACCESS_DIRECTION},
              {"events", "type", "push", EVENT_PUSH},
              {"events", "type", "pour", EVENT_POUR},
              {"events", "type", "tilt", EVENT_TILT},
              {"events", "type", "style", EVENT_STYLE},
              {"events", "type", "camera", EVENT_CAMERA},
              {"events", "type", "drag", EVENT_DRAG},
              {"events", "type", "emitter", EVENT_EMITTER}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    SceneChoices choices;
    scene_choices(scene_field_find(object_of(rows[i].object), rows[i].key), &choices);
    assert_in_range(rows[i].value, 0, choices.count - 1);
    assert_string_equal(choices.names[rows[i].value], rows[i].name);
  }
}

/// Every row: a default that is in its own range, a doc that is one sentence, a range that can be read.
static void check_rows(const SceneObject *object) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    size_t length = strlen(field->doc);
    assert_true(length > 5 && field->doc[length - 1] == '.');
    if (field->type == SCENE_OBJECT || field->type == SCENE_LIST || field->type == SCENE_VARIANT) {
      check_rows(field->object);
    } else if (*field->range == '[' || *field->range == '(') {
      SceneInterval interval = scene_interval(field);
      assert_true(interval.low <= interval.high);
      size_t end = strlen(field->range) - 1;
      assert_true(strchr(field->range, ',') && (field->range[end] == ']' || field->range[end] == ')'));
      double number = field->fallback ? strtod(field->fallback + strspn(field->fallback, "["), NULL) : interval.high;
      assert_true(!field->fallback || !strcmp(field->fallback, "null") || scene_interval_has(&interval, number));
    }
  }
}

static void test_rows_of_the_table_make_sense(void **state) {
  (void)state;
  check_rows(&scene_top);
}

/// Create a world from the scene; whether the simulator takes it.
static bool simulator_takes(const Scene *scene) {
  SimWorldDef def = scene_world_def(scene);
  def.threads = 1;
  SimError error;
  SimWorld *world = sim_world_create(&def, &error);
  sim_world_destroy(world);
  return world != NULL;
}

/// Whether the simulator takes the scene with one number changed.
static bool takes_number(const SceneField *field, double value, float towards) {
  Scene scene = load("{\"version\": 1, \"container\": {\"min\": [0, 0, 0], \"max\": [15, 15, 15]}}");
  char *member = (char *)&scene.simulation + field->offset;
  if (field->type == SCENE_INTEGER)
    *(int32_t *)member = (int32_t)value + (towards < (float)value ? -1 : towards > (float)value ? 1 : 0);
  else
    *(float *)member = nextafterf((float)value, towards);
  bool takes = simulator_takes(&scene);
  scene_free(&scene);
  return takes;
}

static void test_ranges_are_those_of_the_simulator(void **state) {
  (void)state;
  const SceneObject *object = scene_field_find(&scene_top, "simulation")->object;
  int checked = 0;
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    // The table allows less time per step than the simulator would.
    if ((field->type != SCENE_NUMBER && field->type != SCENE_INTEGER) || strcmp(field->key, "time_step") == 0) continue;
    SceneInterval interval = scene_interval(field);
    if (!takes_number(field, interval.low, (float)interval.low)) fail_msg("%s: low end refused", field->key);
    if (!takes_number(field, interval.high, (float)interval.high)) fail_msg("%s: high end refused", field->key);
    if (takes_number(field, interval.low, -INFINITY)) fail_msg("%s: less than the low end taken", field->key);
    if (takes_number(field, interval.high, INFINITY)) fail_msg("%s: more than the high end taken", field->key);
    checked++;
  }
  assert_int_equal(checked, 14);
}

/// Whether the renderer takes the scene with a number, or three, at the end of its range.
static void check_end(const SceneField *field, size_t offset, double value) {
  bool vector = field->type == SCENE_VECTOR || field->type == SCENE_DIRECTION || field->type == SCENE_OPTIONAL_VECTOR;
  Scene scene = load("{\"version\": 1}");
  char *member = (char *)&scene + offset;
  for (int k = 0; k < (vector ? 3 : 1); k++) {
    if (field->type == SCENE_INTEGER)
      *(int32_t *)member = (int32_t)value;
    else
      ((float *)member)[k] = (float)value;
  }
  RenderSettings settings = scene_render_settings(&scene);
  RenderError error;
  if (!render_settings_check(&settings, &error)) fail_msg("%s: %s", field->key, error.message);
  scene_free(&scene);
}

static int check_ends(const SceneObject *object, size_t offset) {
  int checked = 0;
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type == SCENE_OBJECT) checked += check_ends(field->object, offset + field->offset);
    if (*field->range != '[' && *field->range != '(') continue;
    SceneInterval interval = scene_interval(field);
    check_end(field, offset + field->offset, interval.low);
    check_end(field, offset + field->offset, interval.high);
    checked++;
  }
  return checked;
}

/// Both ends of every range of light, environment and render, and of the styles in it, must suit the renderer.
static void test_ranges_suit_the_renderer(void **state) {
  (void)state;
  const char *const objects[] = {"light", "environment", "render"};
  int checked = 0;
  for (size_t o = 0; o < sizeof objects / sizeof *objects; o++) {
    const SceneField *owner = scene_field_find(&scene_top, objects[o]);
    checked += check_ends(owner->object, owner->offset);
  }
  assert_true(checked >= 70);
}

static void test_camera_is_found_when_none_is_given(void **state) {
  (void)state;
  Scene scene = load("{\"version\": 1, \"container\": {\"min\": [10, 0, 0], \"max\": [11, 1, 2]}}");
  RenderView view = scene_view(&scene);
  // In front of it, above it, looking at it.
  assert_true(view.eye[2] > 2 && view.eye[1] > 0.5f && view.eye[0] > 9 && view.eye[0] < 12);
  assert_true(view.target[0] == 10.5f && view.target[1] > 0 && view.target[1] < 1 && view.target[2] == 1);
  scene_free(&scene);
}

// ---- Messages -------------------------------------------------------------------------------------------------------

static void test_messages_name_line_path_and_cause(void **state) {
  (void)state;
  refused("{\n \"version\": 1,\n \"simulation\": {\n  \"particle_radius\": -1}}",
          "t.json:4: simulation.particle_radius: must be in [0.0001, 1] m, got -1");
  refused("{\"version\": 1,\n\"simulation\": {\"iterations\":\n 2.5}}",
          "t.json:2: simulation.iterations: must be a whole number in [1, 100], got 2.5");
  refused("{\"version\": 1, \"simulation\": {\"viscosity\": \"a\\u0007b\"}}",
          "t.json:1: simulation.viscosity: must be a number in [0, 0.5], got \"a?b\"");
  refused("{\"version\": 1,\n \"simulation\": {\"gravity\": [0,\n 1e999, 0]}}",
          "t.json:3: simulation.gravity.1: must be in [-1000, 1000] m/s\xc2\xb2, got inf");
  refused("{\"version\": 1, \"light\": {\"sun\": 1}}", "t.json:1: light.sun: must be true or false, got 1");
  refused("{\"version\": 1, \"light\": {\"direction\": [0, 0, 0]}}",
          "t.json:1: light.direction: must not be the zero vector");
  refused("{\"version\": 1, \"name\": [1]}", "t.json:1: name: must be a string, got a list");
  refused("{\"version\": 1,\n\"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1]},\n\n{\"max\": [1, 1, 1]}]}",
          "t.json:4: fluid.1.min: is missing");
  refused("{\"version\": 1,\n\"fluid\": [[]]}", "t.json:2: fluid.0: must be an object, got a list");
  refused("{\"version\": 1, \"render\": {\"tone_map\": \"filmik\"}}",
          "t.json:1: render.tone_map: must be one of none, filmic, got \"filmik\", did you mean \"filmic\"?");
  refused("[]", "t.json:1: must be an object, got a list");
  refused("{}", "t.json:1: version: is missing");
}

static void test_keys_are_known_and_stand_once(void **state) {
  (void)state;
  refused("{\"version\": 1,\n \"simulation\": {\n  \"particle_raduis\": 1}}",
          "t.json:3: simulation.particle_raduis: unknown key, did you mean \"particle_radius\"?");
  refused("{\"version\": 1, \"zzz\": 1}", "t.json:1: zzz: unknown key");
  refused("{\"version\": 1,\n\"name\": \"a\",\n\"name\": \"b\"}", "t.json:3: name: stands here twice");
  refused("{\"version\": 1, \"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1],\n\"n\\u0061me\\n\": 3}]}",
          "t.json:2: fluid.0.name?: unknown key");
  // A key of another kind of item is unknown here.
  refused(
      "{\"version\": 1, \"obstacles\": [{\"type\": \"sphere\", \"radius\": 1, \"position\": [0,0,0], \"height\": 1}]}",
      "t.json:1: obstacles.0.height: unknown key");
  // The version comes first: what follows may be of a later one.
  refused("{\"zzz\": 1,\n\"version\": 2}", "t.json:2: version: must be 1, got 2");
}

static void test_styles_are_those_of_the_renderer(void **state) {
  (void)state;
  for (int32_t i = 0; i < render_style_count(); i++) {
    char text[120];
    snprintf(text, sizeof text, "{\"version\": 1, \"render\": {\"style\": \"%s\"}}", render_style_name(i));
    Scene scene = load(text);
    assert_string_equal(scene_render_settings(&scene).style, render_style_name(i));
    scene_free(&scene);
  }
  refused("{\"version\": 1, \"render\": {\"style\": \"blue\"}}",
          "t.json:1: render.style: must be one of points, refraction, raycast, cartoon, heightfield, got \"blue\"");
}

#define OBSTACLE(text) "{\"version\": 1, \"obstacles\": [{\"type\": " text ", \"position\": [1, 1, 0.5]}]}"
#define EMITTER(text)                                                                                                  \
  "{\"version\": 1, \"fluid\": [{\"type\": \"emitter\", \"direction\": [0, -1, 0], \"position\": [1, 1, 0.5]" text "}" \
  "]"                                                                                                                  \
  "}"

static void test_bodies_must_make_sense(void **state) {
  (void)state;
  refused(OBSTACLE("\"capsule\", \"radius\": 0.2, \"height\": 0.3"),
          "t.json:1: obstacles.0: a capsule must be at least as high as two radii, got 0.3 m and 0.2 m");
  refused(OBSTACLE("\"sphere\", \"radius\": 0.2, \"motion\": \"scripted\""),
          "t.json:1: obstacles.0: a scripted obstacle needs keys or a stroke");
  refused(OBSTACLE("\"sphere\", \"radius\": 0.2, \"stroke\": [0, 0, 1]"),
          "t.json:1: obstacles.0: only a scripted obstacle has keys or a stroke");
  refused(
      OBSTACLE(
          "\"sphere\", \"radius\": 0.2, \"motion\": \"scripted\", \"keys\": [{\"time\": 1, \"position\": [0,0,0]},\n"
          "{\"position\": [0,0,0],\n\"time\": 1}]"),
      "t.json:3: obstacles.0.keys.1.time: must be later than the key before it (1 s), got 1");
  refused(OBSTACLE("\"stairs\", \"size\": [1, 1, 1], \"steps\": 0"),
          "t.json:1: obstacles.0.steps: must be in [1, 1000], got 0");
}

static void test_emitters_and_drops_must_make_sense(void **state) {
  (void)state;
  refused(EMITTER(""), "t.json:1: fluid.0: a disc needs a diameter");
  refused(EMITTER(", \"shape\": \"rectangle\", \"diameter\": 1"), "t.json:1: fluid.0: a rectangle needs a size");
  refused(EMITTER(", \"size\": [1, 2, 3]"), "t.json:1: fluid.0.size: must be a list of two numbers, got 3 items");
  refused(EMITTER(", \"size\": [1, 0]"), "t.json:1: fluid.0.size.1: must be in (0, 1000] m, got 0");
  refused(EMITTER(", \"diameter\": 1, \"start\": 2, \"stop\": 2"), "t.json:1: fluid.0: stop must be later than start");
  refused(EMITTER(", \"diameter\": 1, \"obstacle\": 0"),
          "t.json:1: fluid.0.obstacle: there is no obstacles.0, the list has 0 items");
  refused("{\"version\": 1, \"fluid\": [{\"type\": \"drop\", \"centre\": [9, 9, 9], \"radius\": 1}]}",
          "t.json:1: fluid.0: lies outside the container");
  refused("{\"version\": 1, \"fluid\": [{\"type\": \"drop\", \"centre\": [1, 1, 0.5], \"radius\": 0.3},\n"
          "{\"min\": [0, 0, 0], \"max\": [1, 0.75, 0.5]}]}",
          "t.json:2: fluid.1: overlaps fluid.0");
  refused("{\"version\": 1, \"fluid\": [{\"type\": \"drop\", \"centre\": [1, 1, 0.5], \"radius\": 0.3},\n"
          "{\"type\": \"drop\", \"centre\": [1.4, 1, 0.5], \"radius\": 0.3}]}",
          "t.json:2: fluid.1: overlaps fluid.0");
  refused("{\"version\": 1, \"sinks\": [{\"min\": [0, 0, 0], \"max\": [0, 1, 1]}]}",
          "t.json:1: sinks.0: min must be less than max, but in x 0 is not less than 0");
  // A ball beside the corner of a block does not reach it; nor do balls that touch.
  Scene scene = load("{\"version\": 1, \"fluid\": [{\"type\": \"drop\", \"centre\": [1.2, 1, 0.7], \"radius\": 0.25},"
                     "{\"min\": [0, 0, 0], \"max\": [1, 0.8, 0.5]},"
                     "{\"type\": \"drop\", \"centre\": [1.7, 1, 0.7], \"radius\": 0.25}]}");
  scene_free(&scene);
}

#define RIPPLE(waves, rest)                                                                                            \
  "{\"version\": 1, \"fluid\": [{\"type\": \"ripple\", \"level\": 0.5,\n\"waves\": [" waves "]}]" rest "}"

static void test_a_ripple_becomes_waves(void **state) {
  (void)state;
  Scene scene = load(RIPPLE("{\"amplitude\": 0.01, \"wavelength\": 0.5, \"direction\": [3, 7, -4], \"phase\": 90}, "
                            "{\"amplitude\": 0.02, \"wavelength\": 0.25, \"standing\": true}",
                            ""));
  SimWorldDef def = scene_world_def(&scene);
  assert_true(def.ripple && def.ripple_level == 0.5f && def.wave_count == 2 && def.block_count == 0);
  assert_true(def.waves[0].amplitude == 0.01f && def.waves[0].wavelength == 0.5f && !def.waves[0].standing);
  assert_true(def.waves[0].direction[0] == 3 && def.waves[0].direction[1] == -4);
  assert_float_equal(def.waves[0].phase, 1.5707963f, 1e-6);
  assert_true(def.waves[1].direction[0] == 1 && def.waves[1].direction[1] == 0 && def.waves[1].standing);
  assert_int_equal(scene_particle_count(&scene), 0);
  AppError error = {0};
  SimWorld *world = scene_world_create(&scene, 1, &error);
  assert_non_null(world);
  sim_world_destroy(world);
  scene_free(&scene);
  scene = load(RIPPLE("", "")); // level water
  assert_true(scene_world_def(&scene).ripple && scene_world_def(&scene).wave_count == 0);
  scene_free(&scene);
  scene = load("{\"version\": 1}");
  assert_true(!scene_ripple(&scene) && !scene_world_def(&scene).ripple);
  scene_free(&scene);
}

static void test_ripples_must_make_sense(void **state) {
  (void)state;
  refused("{\"version\": 1, \"fluid\": [{\"type\": \"ripple\"}]}", "t.json:1: fluid.0.level: is missing");
  refused(RIPPLE("{\"amplitude\": 0.01}", ""), "t.json:2: fluid.0.waves.0.wavelength: is missing");
  refused(RIPPLE("{\"amplitude\": 0.01, \"wavelength\": 0.01}", ""),
          "t.json:2: fluid.0.waves.0.wavelength: must be at least 2 x particle_radius = 0.035 m, got 0.01");
  refused(RIPPLE("{\"amplitude\": 0.01, \"wavelength\": 1, \"direction\": [0, 1, 0]}", ""),
          "t.json:2: fluid.0.waves.0.direction: must not point straight up or down");
  refused(
      RIPPLE("{\"amplitude\": 0.6, \"wavelength\": 1}", ""),
      "t.json:1: fluid.0: its waves reach from -0.1 to 1.1 m, which must lie in the container, between 0 and 1.6 m");
  refused("{\"version\": 1, \"fluid\": [{\"type\": \"ripple\", \"level\": 0.5},\n{\"min\": [0, 0, 0], \"max\": [1, 1, "
          "1]}]}",
          "t.json:1: fluid.0: a ripple must be the only water of a scene");
  refused("{\"version\": 1, \"fluid\": [{\"min\": [0, 0, 0], \"max\": [1, 1, 1]},\n{\"type\": \"ripple\", \"level\": "
          "0.5}]}",
          "t.json:2: fluid.1: a ripple must be the only water of a scene");
  refused(RIPPLE("", ", \"sinks\": [{\"min\": [0, 0, 0], \"max\": [1, 1, 1]}]"),
          "t.json:2: sinks.0: a ripple has no particles that it could swallow");
  refused(RIPPLE("", ", \"simulation\": {\"gravity\": [0, 0, 0]}"),
          "t.json:2: simulation.gravity: must point downwards for a ripple");
  refused(RIPPLE("", ", \"obstacles\": [{\"type\": \"sphere\", \"radius\": 0.1, \"position\": [1, 1, 0.5], "
                     "\"motion\": \"floating\"}]"),
          "t.json:2: obstacles.0.motion: nothing floats on a ripple: it has no particles to carry it");
  refused(RIPPLE("", ", \"events\": [{\"type\": \"pour\", \"min\": [0, 0, 0], \"max\": [1, 1, 1]}]"),
          "t.json:2: events.0: no water can be poured into a ripple");
}

#define BALL(name)                                                                                                     \
  "{\"type\": \"sphere\", \"radius\": 0.1, \"position\": [1, 1, 0.5], \"motion\": \"draggable\", \"name\": \"" name    \
  "\"}"
#define DRAG(what) "\"events\": [{\"type\": \"drag\", \"position\": [1, 1, 1], \"obstacle\": " what "}]}"

static void test_names_must_stand_for_something(void **state) {
  (void)state;
  refused("{\"version\": 1, \"obstacles\": [" BALL("raft") "],\n" DRAG("\"rafd\""),
          "t.json:2: events.0.obstacle: no obstacle is called \"rafd\", did you mean \"raft\"?");
  refused("{\"version\": 1, \"obstacles\": [" BALL("raft") "],\n" DRAG("\"something else\""),
          "t.json:2: events.0.obstacle: no obstacle is called \"something else\"");
  refused("{\"version\": 1, \"obstacles\": [" BALL("raft") "],\n" DRAG("1"),
          "t.json:2: events.0.obstacle: there is no obstacles.1, the list has 1 items");
  refused("{\"version\": 1, \"obstacles\": [" BALL("a") ",\n" BALL("a") "]}",
          "t.json:2: obstacles.1.name: is also the name of obstacles.0");
  const char *const wrong[][2] = {{"-1", "-1"}, {"0.5", "0.5"}, {"\"\"", "\"\""}, {"null", "null"}, {"[]", "a list"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char text[400], message[200];
    snprintf(text, sizeof text, "{\"version\": 1, " DRAG("%s"), wrong[i][0]);
    snprintf(message, sizeof message,
             "t.json:1: events.0.obstacle: must be a name or a whole number that is not negative, got %s", wrong[i][1]);
    refused(text, message);
  }
  refused(
      "{\"version\": 1, \"obstacles\": [{\"type\": \"sphere\", \"radius\": 0.1, \"position\": [1, 1, 0.5]}],\n" DRAG(
          "0"),
      "t.json:2: events.0: obstacles.0 is not draggable");
  refused("{\"version\": 1, \"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1]}],\n"
          "\"events\": [{\"type\": \"emitter\", \"emitter\": 0, \"on\": true}]}",
          "t.json:2: events.0.emitter: fluid.0 is no emitter");
}

static void test_boxes_must_make_sense(void **state) {
  (void)state;
  refused("{\"version\": 1, \"container\": {\"min\": [0, 2, 0]}}",
          "t.json:1: container: min must be less than max, but in y 2 is not less than 1.6");
  refused("{\"version\": 1,\n\"fluid\": [\n{\"min\": [0, 0, 0], \"max\": [1, 0, 1]}]}",
          "t.json:3: fluid.0: min must be less than max, but in y 0 is not less than 0");
  refused("{\"version\": 1, \"fluid\": [{\"min\": [4, 0, 0], \"max\": [5, 1, 1]}]}",
          "t.json:1: fluid.0: lies outside the container");
  refused(
      "{\"version\": 1, \"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1]},\n{\"min\": [0.9,0,0], \"max\": [2,1,1]}]}",
      "t.json:2: fluid.1: overlaps fluid.0");
  refused("{\"version\": 1, \"simulation\": {\"particle_radius\": 0.001}, \"fluid\": [{\"min\": [0,0,0], \"max\": "
          "[1,1,1]}]}",
          "t.json:1: fluid.0: would hold 125000000 particles of radius 0.001 m, more than the limit of 16777216");
  refused("{\"version\": 1, \"camera\": {\"eye\": [1, 1, 1], \"target\": [1, 1, 1]}}",
          "t.json:1: camera: eye and target must not be the same point");
}

static void test_syntax_errors_name_line_and_cause(void **state) {
  (void)state;
  refused("", "t.json: the file is empty");
  refused("\xef\xbb\xbf \n", "t.json: the file is empty");
  refused("{\"version\": 1,}", "t.json:1: not valid JSON: expected a key in \"\", got '}'");
  refused("{\"version\": 1\n\"name\": 2}", "t.json:2: not valid JSON: expected ',' or '}', got '\"'");
  refused("\n\n{\"version\": 1", "t.json:3: not valid JSON: the text ends inside an object that begins in line 3");
  refused("{\"version\": 1} x", "t.json:1: not valid JSON: expected the end of the text, got 'x'");
  refused("{\"version\": 01}", "t.json:1: not valid JSON: a number with a leading zero");
  refused("{\"name\": \"\\ud800\"}", "t.json:1: not valid JSON: an invalid \\u escape in a string");
  refused("{\"name\": \"\xff\"}", "t.json:1: not valid JSON: a string that is not UTF-8");
  refused("// a scene\n{}",
          "t.json:1: not valid JSON: expected a value (a number, a string in \"\", true, false, null, "
          "[ or {), got '/' (JSON has no comments)");
}

static void test_byte_order_mark_is_accepted(void **state) {
  (void)state;
  Scene scene = load("\xef\xbb\xbf{\"version\": 1, \"name\": \"b\"}");
  assert_string_equal(scene.name, "b");
  scene_free(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_type_of_value_arrives),
      cmocka_unit_test(test_events_are_sorted_and_completed),
      cmocka_unit_test(test_world_def_holds_the_scene),
      cmocka_unit_test(test_world_def_holds_the_method),
      cmocka_unit_test(test_world_def_holds_water_of_every_kind),
      cmocka_unit_test(test_emitters_are_turned_to_their_direction),
      cmocka_unit_test(test_world_def_holds_bodies_and_their_motion),
      cmocka_unit_test(test_names_find_their_items),
      cmocka_unit_test(test_defaults_of_bodies_are_the_simulators),
      cmocka_unit_test(test_render_settings_and_view_hold_the_scene),
      cmocka_unit_test(test_defaults_are_those_of_the_libraries),
      cmocka_unit_test(test_keys_of_the_height_field_arrive),
      cmocka_unit_test(test_names_in_the_table_stand_for_the_right_values),
      cmocka_unit_test(test_rows_of_the_table_make_sense),
      cmocka_unit_test(test_ranges_are_those_of_the_simulator),
      cmocka_unit_test(test_ranges_suit_the_renderer),
      cmocka_unit_test(test_camera_is_found_when_none_is_given),
      cmocka_unit_test(test_messages_name_line_path_and_cause),
      cmocka_unit_test(test_keys_are_known_and_stand_once),
      cmocka_unit_test(test_styles_are_those_of_the_renderer),
      cmocka_unit_test(test_boxes_must_make_sense),
      cmocka_unit_test(test_bodies_must_make_sense),
      cmocka_unit_test(test_emitters_and_drops_must_make_sense),
      cmocka_unit_test(test_a_ripple_becomes_waves),
      cmocka_unit_test(test_ripples_must_make_sense),
      cmocka_unit_test(test_names_must_stand_for_something),
      cmocka_unit_test(test_syntax_errors_name_line_and_cause),
      cmocka_unit_test(test_byte_order_mark_is_accepted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
