#include "render/object_maps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- What shaders know -----------------------------------------------------------------------------------------------

// struct WaterObject of pool.glsl, std430
typedef struct ObjectBlock {
  float plane[4], low[4], high[4], middle[4];
  float eye_refracted[4], a[4], seen_b[4], unscaled_b[4];
} ObjectBlock;

// struct Pool of pool.glsl, std430
typedef struct PoolBlock {
  RenderHeightBlock height;
  RenderCausticsBlock caustics;
  float optics[4];
  int32_t numbers[4];
  RenderColoursBlock colours;
  ObjectBlock objects[RENDER_MAX_WATER_OBJECTS];
} PoolBlock;

static void set4(float out[4], const float v[3], float w) {
  memcpy(out, v, 3 * sizeof *v);
  out[3] = w;
}

static ObjectBlock object_block(const RenderWaterObject *object) {
  ObjectBlock block = {{0}};
  memcpy(block.plane, object->plane, sizeof block.plane);
  set4(block.low, object->axis[0], 0);
  set4(block.high, object->axis[1], object->half_width > 1e-6f ? object->half_width : 1e-6f);
  set4(block.middle, object->middle, 0);
  set4(block.eye_refracted, object->eye_refracted, 0);
  set4(block.a, object->a, 0);
  set4(block.seen_b, object->seen_b, 0);
  set4(block.unscaled_b, object->unscaled_b, 0);
  return block;
}

static bool upload_bodies(RenderPool *pool, const RenderPicture *picture, const RenderWaterObjects *objects,
                          RenderError *error) {
  const RenderObstacles *bodies = &picture->obstacles;
  const int32_t room = bodies->count > 0 ? bodies->count : 1;
  if (pool->capacity < room) {
    int32_t *staging = realloc(pool->staging, sizeof *staging * (size_t)room);
    if (staging == NULL) return gpu_fail(error, "out of memory for %d obstacles", room);
    pool->staging = staging;
    pool->capacity = room;
  }
  pool->surroundings = false;
  pool->staging[0] = -1;
  for (int32_t i = 0; i < bodies->count; ++i) {
    pool->staging[i] = objects->of_obstacle[bodies->obstacle_of_body[i]];
    pool->surroundings = pool->surroundings || pool->staging[i] < 0;
  }
  return gpu_buffer_write(&pool->object_of_body, "objects of bodies", pool->staging, sizeof(int32_t) * (size_t)room,
                          error);
}

bool render_pool_upload(RenderPool *pool, const RenderPicture *picture, const RenderHeightMap *map,
                        const RenderCaustics *caustics, const RenderWaterColours *colours,
                        const RenderWaterObjects *objects, const RenderSurfaceMesh *mesh, float border,
                        RenderError *error) {
  const RenderSettings *settings = picture->settings;
  PoolBlock block = {.height = render_height_block(map),
                     .caustics = render_caustics_block(caustics, picture),
                     .optics = {settings->refractive_index, border, settings->heightfield.trapezium_a,
                                settings->heightfield.trapezium_b},
                     .numbers = {objects->count, mesh->size[0], mesh->size[1], mesh->step},
                     .colours = render_water_colours_block(colours)};
  for (int32_t i = 0; i < objects->count; ++i) block.objects[i] = object_block(&objects->objects[i]);
  return gpu_buffer_write(&pool->pool, "pool", &block, sizeof block, error) &&
         upload_bodies(pool, picture, objects, error);
}

void render_pool_destroy(RenderPool *pool) {
  gpu_buffer_destroy(&pool->pool);
  gpu_buffer_destroy(&pool->object_of_body);
  free(pool->staging);
  *pool = (RenderPool){0};
}

// ---- The maps --------------------------------------------------------------------------------------------------------

// Rays that waves turn out of the picture find objects up to this share of it further out.
#define BORDER 0.08

static bool resize_map(RenderObjectMap *map, const RenderObjectMaps *maps, const char *label,
                       const RenderPicture *picture, RenderError *error) {
  const int32_t width = picture->width + 2 * maps->border, height = picture->height + 2 * maps->border;
  const GpuTextureDesc colour = {label, width, height, GPU_RGBA16F, true};
  const GpuTextureDesc way = {label, width, height, GPU_R32F, false};
  const GpuTargetDesc target = {label, {&map->colour, &map->way}, &maps->depth};
  return gpu_texture_create(&map->colour, &colour, error) && gpu_texture_create(&map->way, &way, error) &&
         gpu_target_create(&map->target, &target, error);
}

bool render_object_maps_resize(RenderObjectMaps *maps, const RenderPicture *picture, RenderError *error) {
  const int32_t longer = picture->width > picture->height ? picture->width : picture->height;
  maps->border = (int32_t)(BORDER * longer) + 1;
  const GpuTextureDesc depth = {"objects: depth", picture->width + 2 * maps->border, picture->height + 2 * maps->border,
                                GPU_DEPTH32F, false};
  return gpu_texture_create(&maps->depth, &depth, error) &&
         resize_map(&maps->maps[RENDER_REFRACTED], maps, "objects: refracted", picture, error) &&
         resize_map(&maps->maps[RENDER_REFLECTED], maps, "objects: reflected", picture, error);
}

void render_object_maps_destroy(RenderObjectMaps *maps) {
  for (int k = 0; k < RENDER_OBJECT_MAP_COUNT; ++k) {
    RenderObjectMap *map = &maps->maps[k];
    for (int shape = 0; shape < SIM_SHAPE_COUNT; ++shape) gpu_program_destroy(&map->program[shape]);
    gpu_texture_destroy(&map->colour);
    gpu_texture_destroy(&map->way);
    gpu_target_destroy(&map->target);
  }
  gpu_texture_destroy(&maps->depth);
  *maps = (RenderObjectMaps){0};
}

static bool prepare(RenderObjectMap *map, const char *defines, int shape, bool reflected, int eyes,
                    RenderError *error) {
  char all[640];
  snprintf(all, sizeof all, "%s#define SHAPE %d\n#define EYES %d\n%s", defines, shape, eyes,
           reflected ? "#define REFLECTED 1\n" : "");
  const GpuProgramDesc desc = {.label = reflected ? "objects: reflected" : "objects: refracted",
                               .file = shape == SIM_MESH ? "object_map_meshes.glsl" : "object_map.glsl",
                               .defines = all};
  return gpu_program_prepare(&map->program[shape], &desc, error);
}

// Pieces along the edges of a mesh's triangles, so that it has some thousand of them.
static int32_t pieces_of(const RenderMesh *mesh) {
  const int32_t enough = 6000, most = 24, triangles = mesh->corner_count / 3;
  int32_t pieces = 1;
  while (pieces < most && (int64_t)triangles * pieces * pieces < enough) ++pieces;
  return pieces;
}

static void draw_meshes(RenderPicture *picture, const RenderPool *pool, GpuDraw draw, bool reflected) {
  const RenderObstacles *bodies = &picture->obstacles;
  draw.cull = reflected ? GPU_CULL_FRONT : GPU_CULL_BACK;
  for (int32_t body = bodies->first[SIM_MESH]; body < bodies->count; ++body) {
    const RenderMesh *mesh = &bodies->meshes.meshes[bodies->mesh_of_body[body - bodies->first[SIM_MESH]]];
    const int32_t which[4] = {body, pool->staging[body], pieces_of(mesh)};
    if (which[1] < 0) continue;
    draw.vertices = mesh->corner_count * which[2] * which[2];
    draw.in.storage[1] = &mesh->corners;
    draw.in.params = which;
    draw.in.params_size = sizeof which;
    gpu_draw(picture->gpu, &draw);
  }
}

static bool draw_map(RenderObjectMaps *maps, RenderObjectMapKind kind, RenderPicture *picture, const RenderPool *pool,
                     GpuDraw draw, const char *defines, RenderError *error) {
  RenderObjectMap *map = &maps->maps[kind];
  const RenderObstacles *bodies = &picture->obstacles;
  const float nothing[4] = {0};
  draw.target = &map->target;
  gpu_clear_colour(&map->target, 0, nothing);
  gpu_clear_colour(&map->target, 1, nothing);
  gpu_clear_depth(&map->target, GPU_FARTHEST);
  for (int shape = 0; shape < SIM_SHAPE_COUNT && bodies->count > 0; ++shape) {
    const int32_t first = bodies->first[shape], count = bodies->first[shape + 1] - first;
    if (count == 0) continue;
    if (!prepare(map, defines, shape, kind == RENDER_REFLECTED, picture->settings->heightfield.eyes, error)) {
      return false;
    }
    draw.program = &map->program[shape];
    if (shape == SIM_MESH) {
      draw_meshes(picture, pool, draw, kind == RENDER_REFLECTED);
      continue;
    }
    draw.first_vertex = 6 * first;
    draw.vertices = 6 * count;
    gpu_draw(picture->gpu, &draw);
  }
  return true;
}

bool render_object_maps_draw(RenderObjectMaps *maps, RenderPicture *picture, const RenderPool *pool, GpuInputs in,
                             const char *defines, RenderError *error) {
  const GpuDraw draw = {.depth = GPU_DEPTH_WRITE, .in = in};
  return draw_map(maps, RENDER_REFRACTED, picture, pool, draw, defines, error) &&
         draw_map(maps, RENDER_REFLECTED, picture, pool, draw, defines, error);
}
