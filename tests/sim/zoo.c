#include "zoo.h"

Zoo zoo_make(void) {
  Zoo zoo;
  SimCubic cubic = sim_cubic_make(SPACING, 2);
  sim_wall_make(&zoo.wall, &cubic);
  zoo.ring = test_mesh_ring(0.15f, 0.06f, 16, 32);
  zoo.plate = test_mesh_box((const float[3]){0.2f, 0.0005f, 0.15f});
  zoo.fields[0] = sim_mesh_distance_create(&zoo.ring.view, &zoo.wall, 2);
  zoo.fields[1] = sim_mesh_distance_create(&zoo.plate.view, &zoo.wall, 2);
  assert_non_null(zoo.fields[0]);
  assert_non_null(zoo.fields[1]);
  return zoo;
}

void zoo_free(Zoo *zoo) {
  for (int n = 0; n < 2; n++) sim_mesh_distance_destroy(zoo->fields[n]);
  test_mesh_free(&zoo->ring);
  test_mesh_free(&zoo->plate);
}

void zoo_turn(SimBody *body, uint64_t *seed, float most) {
  SimObstacle pose = {.shape = SIM_SPHERE, .size = {1}};
  for (int k = 0; k < 3; k++) pose.rotation[k] = most * (float)(2 * test_random(seed) - 1);
  pose.rotation[3] = 1;
  SimBody turned = sim_body_make(&pose, NULL);
  memcpy(body->rotation, turned.rotation, sizeof body->rotation);
}

SimBody zoo_body(const Zoo *zoo, int which) {
  static const struct {
    SimShape shape;
    float size[3];
    int32_t steps;
  } kinds[ZOO] = {[SIM_BOX] = {SIM_BOX, {0.3f, 0.2f, 0.25f}, 1},
                  [SIM_SPHERE] = {SIM_SPHERE, {0.36f}, 1},
                  [SIM_CYLINDER] = {SIM_CYLINDER, {0.28f, 0.3f}, 1},
                  [SIM_CAPSULE] = {SIM_CAPSULE, {0.2f, 0.4f}, 1},
                  [SIM_STAIRS] = {SIM_STAIRS, {0.4f, 0.3f, 0.25f}, 4},
                  [SIM_MESH] = {SIM_MESH, {0}, 1},
                  [SHEET] = {SIM_BOX, {0.4f, 0.001f, 0.4f}, 1},
                  [NEEDLE] = {SIM_BOX, {0.4f, 1e-4f, 1e-4f}, 1},
                  [ONE_STEP] = {SIM_STAIRS, {0.3f, 0.02f, 0.25f}, 1},
                  [PLATE_MESH] = {SIM_MESH, {0}, 1},
                  [BEAD] = {SIM_SPHERE, {0.02f}, 1},
                  [ROUND_CAPSULE] = {SIM_CAPSULE, {0.2f, 0.2f}, 1}};
  SimObstacle obstacle = {.shape = kinds[which].shape,
                          .steps = kinds[which].steps,
                          .position = {0.5f, 0.45f, 0.55f},
                          .rotation = {0.3f, -0.2f, 0.1f, 0.9f}};
  memcpy(obstacle.size, kinds[which].size, sizeof obstacle.size);
  return sim_body_make(&obstacle, which == SIM_MESH ? zoo->fields[0] : which == PLATE_MESH ? zoo->fields[1] : NULL);
}

SimBoundary zoo_tank(const Zoo *zoo, SimContainerShape shape, const SimBody *bodies, int32_t count) {
  return (SimBoundary){.container = {{0, 0, 0}, {1, 1, 1}, shape},
                       .friction = 0.25f,
                       .clearance = CLEARANCE,
                       .body_count = count,
                       .bodies = bodies,
                       .wall = zoo->wall};
}

void zoo_random_point(uint64_t *seed, float point[3]) {
  for (int k = 0; k < 3; k++) point[k] = (float)test_random(seed);
}
