#include "validation.h"

#define PI 3.14159265358979323846
#define G 9.81

// ---- Collapse of a column --------------------------------------------------------------------------------------------

#define FRONTS 15
#define HEIGHTS 13
static const double front_time[FRONTS] = {.41,  .84,  1.19, 1.43, 1.63, 1.83, 1.98, 2.20,
                                          2.32, 2.51, 2.65, 2.83, 2.98, 3.11, 3.33};
static const double front_place[FRONTS] = {1.11, 1.22, 1.44, 1.67, 1.89, 2.11, 2.33, 2.56,
                                           2.78, 3.00, 3.22, 3.44, 3.67, 3.89, 4.11};
static const double height_time[HEIGHTS] = {.56, .77, .93, 1.08, 1.28, 1.46, 1.66, 1.84, 2.00, 2.21, 2.45, 2.70, 3.06};
static const double height_place[HEIGHTS] = {.94, .89, .83, .78, .72, .67, .61, .56, .50, .44, .39, .33, .28};

#define SAMPLES 400
typedef struct Series {
  int count;
  double time[SAMPLES], front[SAMPLES], height[SAMPLES]; ///< s, Z, H
} Series;

static double at(const Series *series, const double *value, double time) {
  if (time <= 0) return 1;
  for (int k = 0; k < series->count; k++) {
    if (series->time[k] < time) continue;
    double t0 = k ? series->time[k - 1] : 0, v0 = k ? value[k - 1] : 1;
    return v0 + (value[k] - v0) * (time - t0) / (series->time[k] - t0);
  }
  return value[series->count - 1];
}

static int compare_floats(const void *a, const void *b) {
  float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

// A percentile of the coordinate `axis` over the particles whose coordinate `other` is below a limit, and a radius more.
static double percentile(const SimFrame *frame, int axis, int other, double limit, double share) {
  float *values = malloc(sizeof(float) * ((size_t)frame->count + 1));
  int count = 0;
  for (int32_t i = 0; i < frame->count; i++)
    if ((double)frame->position[3 * i + other] < limit) values[count++] = frame->position[3 * i + axis];
  qsort(values, (size_t)count, sizeof(float), compare_floats);
  double value = count ? (double)(values[(int)(share * (count - 1))] + frame->particle_radius) : 0;
  free(values);
  return value;
}

static void run_collapse(SimWorldDef *def, double a, Series *series) {
  SimWorld *world = test_create(def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {""};
  double step = 0.02 * sqrt(a / G), end = 3.1 * sqrt(a / G);
  for (series->count = 0; series->count < SAMPLES && series->count * step < end; series->count++) {
    if (!sim_world_advance(world, step, &error)) fail_msg("%s", error.message);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    series->time[series->count] = frame->time;
    series->front[series->count] = percentile(frame, 0, 1, 0.15 * a, 0.99) / a;
    series->height[series->count] = percentile(frame, 1, 0, 0.1 * a, 0.98) / (2 * a);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void compare_front(const Series *series, double a, ColumnCollapse *result) {
  double unit = sqrt(a / (2 * G)); // T = t/unit
  result->front_rms = INFINITY;
  for (int s = -20; s <= 20; s++) {
    double sum = 0, most = 0;
    for (int k = 0; k < FRONTS; k++) {
      double error = at(series, series->front, (front_time[k] + 0.01 * s) * unit) / front_place[k] - 1;
      sum += error * error;
      most = fmax(most, fabs(error));
    }
    if (sqrt(sum / FRONTS) >= result->front_rms) continue;
    result->front_rms = sqrt(sum / FRONTS);
    result->front_largest = most;
    result->shift = 0.01 * s;
  }
  result->ritter_excess = -INFINITY;
  for (int k = 0; k < series->count; k++)
    result->ritter_excess = fmax(result->ritter_excess, series->front[k] - 1 - 2 * series->time[k] / unit);
}

ColumnCollapse validate_column_collapse(SimSolver solver, double a, int across, int deep) {
  SimWorldDef def = sim_default_world_def();
  float d = (float)(a / across), width = (float)deep * d;
  SimBlockDef block = {{0, 0, 0}, {(float)a, (float)(2 * a), width}};
  def.solver = solver;
  def.threads = 2;
  def.particle_radius = d / 2;
  def.container = (SimContainer){{0, 0, 0}, {(float)(6 * a), (float)(2.5 * a), width}};
  def.blocks = &block;
  def.block_count = 1;
  Series series;
  ColumnCollapse result = {0};
  run_collapse(&def, a, &series);
  compare_front(&series, a, &result);
  for (int k = 0; k < HEIGHTS; k++)
    result.height_largest = fmax(result.height_largest,
                                 fabs(at(&series, series.height, height_time[k] * sqrt(a / G)) - height_place[k]));
  return result;
}

// ---- Standing wave ---------------------------------------------------------------------------------------------------

// The water's centre along x swings with the first mode. Its zeros, interpolated, give the period, and its largest distance
// between two zeros the height.
static StandingWave swing(SimWorld *world, double length, double step, int steps) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {""};
  double last = 0, first_zero = 0, last_zero = 0, most = 0, first_most = 0, last_most = 0;
  int zeros = 0;
  for (int s = 0; s < steps; s++) {
    if (!sim_world_advance(world, step, &error)) fail_msg("%s", error.message);
    const SimFrame *frame = test_frame(world, 0, buffer);
    double centre = 0;
    for (int32_t i = 0; i < frame->count; i++) centre += (double)frame->position[3 * i] / frame->count;
    double now = centre - length / 2;
    if (s > 0 && (now > 0) != (last > 0)) {
      double zero = frame->time - step * now / (now - last);
      if (zeros == 0) first_zero = zero;
      if (zeros == 1) first_most = most;
      last_zero = zero;
      last_most = most;
      zeros++;
      most = 0;
    }
    most = fmax(most, fabs(now));
    last = now;
  }
  sim_frame_buffer_destroy(buffer);
  if (zeros < 4) fail_msg("%d zeros only", zeros);
  return (StandingWave){2 * (last_zero - first_zero) / (zeros - 1), pow(last_most / first_most, 1.0 / (zeros - 2))};
}

StandingWave validate_standing_wave(SimSolver solver, int layers, double amplitude, double jitter) {
  SimWorldDef def = sim_default_world_def();
  const double d = 0.02, depth = layers * d, length = 2 * depth;
  int columns = 2 * layers;
  SimBlockDef *blocks = calloc((size_t)columns, sizeof *blocks);
  for (int k = 0; k < columns; k++) { // columns whose height follows the mode
    double level = depth + amplitude * depth * cos(PI * (k + 0.5) / columns);
    blocks[k] = (SimBlockDef){{(float)(k * d), 0, 0}, {(float)((k + 1) * d), (float)(d * round(level / d)), (float)(6 * d)}};
  }
  def.solver = solver;
  def.threads = 2;
  def.jitter = (float)jitter;
  def.particle_radius = (float)(d / 2);
  def.container = (SimContainer){{0, 0, 0}, {(float)length, (float)(2 * depth), (float)(6 * d)}};
  def.blocks = blocks;
  def.block_count = columns;
  SimWorld *world = test_create(&def);
  double k = PI / length, expected = 2 * PI / sqrt(G * k * tanh(k * depth));
  StandingWave wave = swing(world, length, expected / 60, 60 * 4);
  wave.period /= expected;
  sim_world_destroy(world);
  free(blocks);
  return wave;
}
