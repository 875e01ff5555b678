// Smoothing kernels in three dimensions, with support radius h.
//
// Cubic spline: Monaghan, Smoothed Particle Hydrodynamics, 1992. Poly6 and spiky: Müller, Charypar, Gross, Particle-Based
// Fluid Simulation for Interactive Applications, 2003, Eq. 20 and 21 (with 64π, not 65π, in poly6). Wendland C2:
// Wendland, Piecewise Polynomial, Positive Definite and Compactly Supported Radial Functions, 1995.
//
// The solver uses the cubic spline for density and gradient alike, so that a correction moves along the true gradient of
// the constraint. The others are here for comparison and for whoever writes the next solver.
#ifndef LIDO_SIM_KERNELS_H
#define LIDO_SIM_KERNELS_H

#include <stdint.h>

typedef struct SimKernelFunction {
  const char *name;
  double (*value)(double r, double h);      ///< W, 1/m³
  double (*derivative)(double r, double h); ///< dW/dr, 1/m⁴, never positive
} SimKernelFunction;

#define SIM_KERNEL_COUNT 4
extern const SimKernelFunction sim_kernels[SIM_KERNEL_COUNT]; ///< cubic spline, poly6, spiky, Wendland C2

double sim_kernel_cubic(double r, double h);
double sim_kernel_cubic_derivative(double r, double h);

/// Softening of diffusion at small distances: see diffusion.c.
#define SIM_DIFFUSE_SOFT 0.01f

/// The cubic spline in single precision for one support radius and one particle spacing, times the volume V of a
/// particle. V is calibrated so that a particle inside the cubic lattice of that spacing sees exactly V Σ W = 1 (its own
/// W included): at rest the fluid is neither compressed nor stretched, and the mass of a particle is ρ0 V.
typedef struct SimCubic {
  float h, inverse_h;   ///< m, 1/m
  float spacing;        ///< m
  float volume;         ///< m³, V: within a few percent of spacing³
  float value_scale;    ///< V · 8/(πh³): V W(0)
  float gradient_scale; ///< 1/m, V · 8/(πh⁴)
  float omega;          ///< damping of a Jacobi iteration on densities with this kernel
  float diffuse_moment; ///< Σ V |dW/dr| r³/(3 (r² + soft h²)) in the lattice: near 1
  float diffuse_degree; ///< 1/m², Σ V |dW/dr| r/(r² + soft h²) there
  float lattice_gradient; ///< 1/m², Σ |V ∇W|² over the neighbours in the lattice: makes ε and k of the solver free of scale
} SimCubic;

SimCubic sim_cubic_make(float spacing, float support);

/// Σ W over the points of a cubic lattice, the centre included.
double sim_lattice_sum(double (*value)(double r, double h), double spacing, double h);

// With q = r/h and a = max(0, 1 − q), b = max(0, ½ − q) both branches of the spline are one expression:
// 6q³ − 6q² + 1 = 2(1 − q)³ − 8(½ − q)³ for q ≤ ½.

/// V W(r), without unit.
static inline float sim_cubic_value(const SimCubic *cubic, float r) {
  float q = r * cubic->inverse_h;
  float a = q < 1 ? 1 - q : 0, b = q < 0.5f ? 0.5f - q : 0;
  return cubic->value_scale * (2 * a * a * a - 8 * b * b * b);
}

/// V dW/dr, 1/m, never positive.
static inline float sim_cubic_gradient(const SimCubic *cubic, float r) {
  float q = r * cubic->inverse_h;
  float a = q < 1 ? 1 - q : 0, b = q < 0.5f ? 0.5f - q : 0;
  return cubic->gradient_scale * (24 * b * b - 6 * a * a);
}

#endif
