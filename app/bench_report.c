// What `lido bench` prints, as a table and as JSON.
//
// The distance to the limits of the machine rests on what a sweep has to do at least, however it is written. A pair of
// the density sweep: difference and squared distance of two positions, root, kernel and gradient, five sums; 32 operations
// as wide/pbf.c writes them, so 16 multiply-adds if each were half of one. A pair of the correction: 28, so 14. Every
// pair of a sweep also streams its index, 4 bytes, and every particle its own place in and out, 32 bytes.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/bench.h"

enum { DENSITY_MULTIPLY_ADDS = 16, CORRECT_MULTIPLY_ADDS = 14, BYTES_A_PAIR = 4, BYTES_A_PARTICLE = 32 };

static BenchRow *row_named(Bench *bench, const char *group, const char *name) {
  for (int i = 0; i < bench->row_count; i++)
    if (!strcmp(bench->rows[i].group, group) && !strcmp(bench->rows[i].name, name)) return &bench->rows[i];
  return NULL;
}

/// How near the two sweeps of a density iteration come to what the machine can do.
typedef struct Limits {
  bool known;           ///< pbf only: other methods sweep otherwise
  double sweeps;        ///< of each kind in a substep
  double multiply_adds; ///< a second
  double bytes;         ///< a second
} Limits;

static Limits limits_of(Bench *bench) {
  Limits limits = {0};
  SimWorldDef def = scene_world_def(&bench->scene);
  BenchRow *density = row_named(bench, "sim", sim_stage_name(SIM_STAGE_density));
  BenchRow *correct = row_named(bench, "sim", sim_stage_name(SIM_STAGE_correct));
  double seconds = density && correct ? (bench_median(&density->each) + bench_median(&correct->each)) * 1e-9 : 0;
  if (def.solver != SIM_SOLVER_PBF || !(seconds > 0) || bench->particle_steps == 0) return limits;
  double pairs = (double)bench->pairs / (double)bench->particle_steps;
  limits.known = true;
  limits.sweeps = def.iterations;
  limits.multiply_adds = limits.sweeps * pairs * (DENSITY_MULTIPLY_ADDS + CORRECT_MULTIPLY_ADDS) / seconds;
  limits.bytes = limits.sweeps * 2 * (pairs * BYTES_A_PAIR + BYTES_A_PARTICLE) / seconds;
  return limits;
}

static double per(double sum, double count) {
  return count > 0 ? sum / count : 0;
}

/// Steps a second of simulation and surface together, as papers tell it.
typedef struct Steps {
  double as_run; ///< with the surface once a frame
  double each;   ///< as if it were made after every substep
} Steps;

static Steps steps_of(Bench *bench) {
  BenchRow *total = row_named(bench, "sim", "total");
  double substeps = per((double)bench->substeps, bench->frames), surface = 0;
  if (!total || !(substeps > 0)) return (Steps){0, 0};
  for (int s = SIM_STAGE_frame; s < SIM_STAGE_COUNT; s++) {
    BenchRow *row = row_named(bench, "sim", sim_stage_name((SimStage)s));
    if (row) surface += bench_median(&row->milliseconds);
  }
  double all = bench_median(&total->milliseconds), alone = fmax(all - surface, 0) / substeps;
  return (Steps){per(1e3 * substeps, all), per(1e3, alone + surface)};
}

// ---- Table -----------------------------------------------------------------------------------------------------------

static void print_row(BenchRow *row) {
  double middle = bench_median(&row->milliseconds); // sorts
  printf("%-6s %-24s %12.3f %12.3f", row->group, row->name, middle, row->milliseconds.value[0]);
  if (row->each.count > 0) printf(" %12.2f", bench_median(&row->each));
  if (row->pair.count > 0) printf(" %12.3f", bench_median(&row->pair));
  printf("\n");
}

static void print_scaling(const Bench *bench) {
  printf("\nthe world alone on");
  for (int r = 0; r < bench->run_count; r++)
    printf("%s %d thread%s: %.2f ms a frame (%.2f times as fast)", r > 0 ? "," : "", bench->runs[r].threads,
           bench->runs[r].threads > 1 ? "s" : "", bench->runs[r].median_ms,
           per(bench->runs[0].median_ms, bench->runs[r].median_ms));
  printf("\n");
}

static void print_limits(Bench *bench) {
  const SimMachine *machine = &bench->machine;
  Limits limits = limits_of(bench);
  printf("\nthis machine at best (%s): %.1f thousand million multiply-adds a second, copies %.1f GB/s (read and "
         "written)\n",
         machine->instruction_set, machine->fma_per_second * 1e-9, machine->copy_per_second * 1e-9);
  if (!limits.known) return;
  printf(
      "density and correction, %.0f sweeps of each a substep:\n"
      "  %.1f thousand million useful multiply-adds a second, %.0f %% of that (counting %d a pair in a density sweep, "
      "%d in a correction)\n"
      "  %.1f GB/s streamed, %.0f %% of the copy's (counting %d bytes a pair and %d a particle in each sweep)\n",
      limits.sweeps, limits.multiply_adds * 1e-9, 100 * per(limits.multiply_adds, machine->fma_per_second),
      DENSITY_MULTIPLY_ADDS, CORRECT_MULTIPLY_ADDS, limits.bytes * 1e-9,
      100 * per(limits.bytes, machine->copy_per_second), BYTES_A_PAIR, BYTES_A_PARTICLE);
}

void bench_print_table(Bench *bench, const SimCounts *counts) {
  printf("%s: %d particles, %d frames of 1/%.0f s, %.1f substeps each\n", bench->scene.path, counts->particles,
         bench->frames, 1 / bench->frame_seconds, (double)bench->substeps / bench->frames);
  if (bench->render) printf("style %s on %s\n", bench->settings.style, render_gl_description(bench->render));
  // The stages of the step run in every substep, those of the frame once: "ns each" is of one of those.
  printf("\n%-6s %-24s %12s %12s %12s %12s\n", "", "", "median ms", "least ms", "ns/particle", "ns/pair");
  for (int i = 0; i < bench->row_count; i++) print_row(&bench->rows[i]);
  printf("ns: medians, per particle or neighbour pair (i, j) and substep; from %s on, per particle or pair and frame\n",
         sim_stage_name(SIM_STAGE_frame));
  if (bench->particle_steps > 0)
    printf("\nsimulator: %.3f us per particle and substep, %.2f ns per neighbour pair, %.1f neighbours per particle, "
           "%.0f bytes per particle (%.0f with a frame)\n",
           bench->simulated_ms * 1e3 / (double)bench->particle_steps,
           per(bench->simulated_ms * 1e6, (double)bench->pairs), (double)bench->pairs / (double)bench->particle_steps,
           per((double)bench->world_bytes, counts->particles), per((double)sim_bytes_in_use(), counts->particles));
  Steps steps = steps_of(bench);
  printf("simulation and surface: %.0f substeps a second, %.0f if the surface were made after each\n", steps.as_run,
         steps.each);
  print_scaling(bench);
  print_limits(bench);
}

// ---- JSON ------------------------------------------------------------------------------------------------------------

static void print_json_row(BenchRow *row, bool last) {
  double middle = bench_median(&row->milliseconds); // sorts
  printf("  {\"group\": \"%s\", \"name\": \"%s\", \"median_ms\": %.6f, \"least_ms\": %.6f", row->group, row->name,
         middle, row->milliseconds.value[0]);
  if (row->each.count > 0) printf(", \"ns_per_particle\": %.4f", bench_median(&row->each));
  if (row->pair.count > 0) printf(", \"ns_per_pair\": %.5f", bench_median(&row->pair));
  printf("}%s\n", last ? "" : ",");
}

static void print_json_limits(Bench *bench) {
  Limits limits = limits_of(bench);
  printf(" \"machine\": {\"instruction_set\": \"%s\", \"fma_per_second\": %.6g, \"copy_bytes_per_second\": %.6g}",
         bench->machine.instruction_set, bench->machine.fma_per_second, bench->machine.copy_per_second);
  if (limits.known)
    printf(
        ",\n \"density_and_correct\": {\"sweeps\": %.0f, \"multiply_adds_per_pair\": [%d, %d], \"bytes_per_pair\": %d, "
        "\"bytes_per_particle\": %d, \"multiply_adds_per_second\": %.6g, \"bytes_per_second\": %.6g}",
        limits.sweeps, DENSITY_MULTIPLY_ADDS, CORRECT_MULTIPLY_ADDS, BYTES_A_PAIR, BYTES_A_PARTICLE,
        limits.multiply_adds, limits.bytes);
  printf("}\n");
}

void bench_print_json(Bench *bench, const SimCounts *counts) {
  printf("{\"particles\": %d, \"frames\": %d, \"substeps\": %lld, \"neighbour_pairs\": %lld, \"bytes\": %zu, "
         "\"world_bytes\": %zu,\n",
         counts->particles, bench->frames, (long long)bench->substeps, (long long)bench->pairs, sim_bytes_in_use(),
         bench->world_bytes);
  printf(" \"microseconds_per_particle_and_substep\": %.6f, \"neighbours_per_particle\": %.3f,\n",
         per(bench->simulated_ms * 1e3, (double)bench->particle_steps),
         per((double)bench->pairs, (double)bench->particle_steps));
  Steps steps = steps_of(bench);
  printf(" \"substeps_per_second\": %.3f, \"substeps_per_second_with_a_surface_each\": %.3f,\n", steps.as_run,
         steps.each);
  printf(" \"rows\": [\n");
  for (int i = 0; i < bench->row_count; i++) print_json_row(&bench->rows[i], i + 1 == bench->row_count);
  printf(" ],\n \"scaling\": [");
  for (int r = 0; r < bench->run_count; r++)
    printf("%s{\"threads\": %d, \"median_ms\": %.6f}", r > 0 ? ", " : "", bench->runs[r].threads,
           bench->runs[r].median_ms);
  printf("],\n");
  print_json_limits(bench);
}
