// Stairs: exact distance and share of the density sum.
//
// In the plane of the profile, with X and Y measured from the foot, step k = 0 … n − 1 is the column from k·w to (k +
// 1)·w with the height (k + 1)·r. The solid is the union of the boxes B_k = [k·w, n·w] × [0, (k + 1)·r]; what lies
// before and above it is the union of the quadrants Q_k = {X < k·w, Y > k·r}, k = 0 … n. So the distance from outside
// is the least distance to a B_k, and the depth inside is the least distance to a Q_k, to the underside or to the back.
//
// The squared distance to B_k, max(k·w − X, 0)² + max(Y − (k + 1)·r, 0)², is convex in k, and so is that to Q_k. Over
// the real numbers its minimum lies at (w X + r (Y − r))/(w² + r²), for Q_k at (w X + r Y)/(w² + r²); over the whole
// numbers it lies beside it. Two candidates do, however many steps there are. Beyond the profile, the distance along z
// joins as for every prism.
//
// The share is the sum over the columns, which share no volume, each of them a product of slabs as for a box (wall.h).
// So in an inner corner the water sees just what two walls at right angles give. Columns out of reach are left out.
#include "sim/stairs.h"

#include <math.h>

#include "sim/obstacles.h"

typedef struct Profile {
  float width, rise;    ///< m, of one step
  float length, height; ///< m, of the flight
  int32_t steps;
} Profile;

static Profile profile_of(const SimStairs *stairs) {
  float length = 2 * stairs->half[0], height = 2 * stairs->half[1], n = (float)stairs->steps;
  return (Profile){length / n, height / n, length, height, stairs->steps};
}

static int32_t whole_below(float value, int32_t most) {
  return value >= (float)most ? most : value > 0 ? (int32_t)value : 0;
}

static float distance_to_box(const Profile *p, int32_t k, float x, float y, float normal[3]) {
  float front = (float)k * p->width - x, back = x - p->length, top = y - (float)(k + 1) * p->rise;
  const float excess[3] = {sim_larger(front, back), sim_larger(top, -y), 0};
  float distance = sim_rounded_distance(excess, 2, normal);
  if (front > back) normal[0] = -normal[0];
  if (top < -y) normal[1] = -normal[1];
  return distance;
}

// Never negative: the point is inside the flight, so in no quadrant. The normal points to the quadrant.
static float distance_to_quadrant(const Profile *p, int32_t k, float x, float y, float normal[3]) {
  const float excess[3] = {x - (float)k * p->width, (float)k * p->rise - y, 0};
  float distance = sim_rounded_distance(excess, 2, normal);
  normal[0] = -normal[0];
  return distance;
}

static float depth_inside(const Profile *p, float x, float y, float normal[3]) {
  float best, other, n[3], along = (p->width * x + p->rise * y) / (p->width * p->width + p->rise * p->rise);
  int32_t k = whole_below(along, p->steps);
  best = distance_to_quadrant(p, k, x, y, normal);
  if (k < p->steps && (other = distance_to_quadrant(p, k + 1, x, y, n)) < best)
    best = other, normal[0] = n[0], normal[1] = n[1];
  if (y < best) best = y, normal[0] = 0, normal[1] = -1;
  if (p->length - x < best) best = p->length - x, normal[0] = 1, normal[1] = 0;
  return best;
}

static float profile_distance(const Profile *p, float x, float y, float normal[3]) {
  float best, other, n[3];
  float along = (p->width * x + p->rise * (y - p->rise)) / (p->width * p->width + p->rise * p->rise);
  int32_t k = whole_below(along, p->steps - 1);
  best = distance_to_box(p, k, x, y, normal);
  if (k < p->steps - 1 && (other = distance_to_box(p, k + 1, x, y, n)) < best)
    best = other, normal[0] = n[0], normal[1] = n[1];
  return best > 0 ? best : -depth_inside(p, x, y, normal);
}

float sim_stairs_distance(const SimStairs *stairs, const float point[3], float normal[3]) {
  Profile profile = profile_of(stairs);
  float across[3], share[3];
  const float excess[3] = {profile_distance(&profile, point[0] + stairs->half[0], point[1] + stairs->half[1], across),
                           fabsf(point[2]) - stairs->half[2], 0};
  float distance = sim_rounded_distance(excess, 2, share);
  normal[0] = share[0] * across[0];
  normal[1] = share[0] * across[1];
  normal[2] = copysignf(share[1], point[2]);
  return distance;
}

float sim_stairs_solid(const SimStairs *stairs, const SimWall *wall, const float point[3], float gradient[3]) {
  Profile p = profile_of(stairs);
  float x = point[0] + stairs->half[0], y = point[1] + stairs->half[1];
  float sum = 0, sum_x = 0, sum_y = 0, slope_z, left_slope, right_slope, top_slope, under_slope;
  gradient[0] = gradient[1] = gradient[2] = 0;
  if (x < -wall->reach || x > p.length + wall->reach) return 0;
  float z_share = sim_wall_slab(wall, point[2], stairs->half[2], &slope_z);
  if (z_share == 0) return 0;
  int32_t first = whole_below((x - wall->reach) / p.width, p.steps - 1),
          last = whole_below((x + wall->reach) / p.width, p.steps - 1);
  float under = sim_wall_share(wall, y, &under_slope);
  float left = sim_wall_share(wall, x - (float)first * p.width, &left_slope);
  for (int32_t k = first; k <= last; k++) {
    float right = sim_wall_share(wall, x - (float)(k + 1) * p.width, &right_slope);
    float top = sim_wall_share(wall, y - (float)(k + 1) * p.rise, &top_slope);
    sum += (right - left) * (top - under);
    sum_x += (right_slope - left_slope) * (top - under);
    sum_y += (right - left) * (top_slope - under_slope);
    left = right, left_slope = right_slope;
  }
  gradient[0] = sum_x * z_share;
  gradient[1] = sum_y * z_share;
  gradient[2] = sum * slope_z;
  return sum * z_share;
}
