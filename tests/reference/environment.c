#include "tests/reference/environment.h"

Environment environment_create(const SimFrame *frame, const RenderSettings *settings) {
  const bool level_given = !isnan(settings->floor_level);
  return (Environment){
      .zenith = vec_of(settings->sky_zenith),
      .horizon = vec_of(settings->sky_horizon),
      .has_floor = settings->floor != RENDER_FLOOR_NONE,
      .floor_level = (double)(level_given ? settings->floor_level : frame->container.min[1]),
      .tile = (double)settings->tile_size,
      .floor_colour = {vec_of(settings->floor_colour[0]), vec_of(settings->floor_colour[1])},
      .solids = solids_create(frame),
  };
}

void environment_destroy(Environment *environment) {
  solids_destroy(&environment->solids);
}

static Vec checker(const Environment *e, Vec p) {
  const double sum = floor(p.x / e->tile) + floor(p.z / e->tile);
  return e->floor_colour[fmod(fabs(sum), 2) != 0];
}

// A matt body under the whole sky: the mean of the gradient over the hemisphere around its normal, weighted by the cosine.
static Vec matt(const Environment *e, Vec colour, Vec normal) {
  return vec_times(colour, vec_mix(e->horizon, e->zenith, 0.25 + 0.25 * normal.y));
}

Vec environment_light(const Environment *e, Vec origin, Vec direction, double *t) {
  Vec normal = {0, 1, 0};
  const Solid *solid = solids_meet(&e->solids, origin, direction, t, &normal);
  const double to_floor = (e->floor_level - origin.y) / direction.y;
  if (e->has_floor && to_floor > 0 && to_floor < *t && isfinite(to_floor)) {
    *t = to_floor;
    return checker(e, vec_along(origin, to_floor, direction));
  }
  if (solid != NULL) return matt(e, solid->colour, normal);
  return vec_mix(e->horizon, e->zenith, fmax(0, direction.y));
}
