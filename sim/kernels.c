#include "sim/kernels.h"

#include <math.h>

#define PI 3.14159265358979323846

double sim_kernel_cubic(double r, double h) {
  double q = r / h, scale = 8 / (PI * h * h * h);
  if (q >= 1) return 0;
  return scale * (q <= 0.5 ? 6 * q * q * q - 6 * q * q + 1 : 2 * (1 - q) * (1 - q) * (1 - q));
}

double sim_kernel_cubic_derivative(double r, double h) {
  double q = r / h, scale = 48 / (PI * h * h * h * h);
  if (q >= 1) return 0;
  return scale * (q <= 0.5 ? q * (3 * q - 2) : -(1 - q) * (1 - q));
}

static double poly6(double r, double h) {
  double s = h * h - r * r;
  return r < h ? 315 / (64 * PI * pow(h, 9)) * s * s * s : 0;
}

static double poly6_derivative(double r, double h) {
  double s = h * h - r * r;
  return r < h ? -945 / (32 * PI * pow(h, 9)) * r * s * s : 0;
}

static double spiky(double r, double h) {
  return r < h ? 15 / (PI * pow(h, 6)) * pow(h - r, 3) : 0;
}

static double spiky_derivative(double r, double h) {
  return r < h ? -45 / (PI * pow(h, 6)) * (h - r) * (h - r) : 0;
}

static double wendland(double r, double h) {
  double q = r / h;
  return q < 1 ? 21 / (2 * PI * h * h * h) * pow(1 - q, 4) * (4 * q + 1) : 0;
}

static double wendland_derivative(double r, double h) {
  double q = r / h;
  return q < 1 ? -210 / (PI * pow(h, 4)) * q * pow(1 - q, 3) : 0;
}

const SimKernelFunction sim_kernels[SIM_KERNEL_COUNT] = {
    {"cubic spline", sim_kernel_cubic, sim_kernel_cubic_derivative},
    {"poly6", poly6, poly6_derivative},
    {"spiky", spiky, spiky_derivative},
    {"Wendland C2", wendland, wendland_derivative},
};

double sim_lattice_sum(double (*value)(double r, double h), double spacing, double h) {
  int reach = (int)ceil(h / spacing);
  double sum = 0;
  for (int k = -reach; k <= reach; k++)
    for (int j = -reach; j <= reach; j++)
      for (int i = -reach; i <= reach; i++) sum += value(spacing * sqrt(i * i + j * j + k * k), h);
  return sum;
}

static double squared_derivative(double r, double h) {
  double derivative = sim_kernel_cubic_derivative(r, h);
  return derivative * derivative;
}

// Damping ω of a Jacobi iteration Δp = ∇λ, λ = −ω C/S, on a density ripple of wave number k. The kernel passes the
// share Ŵ(k) ≈ exp(−a k²), a = 3h²/80 (half its variance along one axis), once in the density and once in Δp, so one
// iteration changes the ripple by the factor 1 − ω k² Ŵ²/S: at worst (k² = 1/2a) by 1 − ω/(2 a e S). ω makes that −0.85.
static double jacobi_damping(double lattice_gradient, double h) {
  double worst = 1 / (2 * 3 * h * h / 80 * exp(1) * lattice_gradient);
  return fmin(1, 1.85 / worst);
}

static double diffuse_degree(double r, double h) {
  return -sim_kernel_cubic_derivative(r, h) * r / (r * r + (double)SIM_DIFFUSE_SOFT * h * h);
}

static double diffuse_moment(double r, double h) {
  return diffuse_degree(r, h) * r * r / 3;
}

SimCubic sim_cubic_make(float spacing, float support) {
  double h = (double)support * spacing;
  double volume = 1 / sim_lattice_sum(sim_kernel_cubic, spacing, h);
  double value_scale = volume * 8 / (PI * h * h * h);
  double gradient = volume * volume * sim_lattice_sum(squared_derivative, spacing, h);
  return (SimCubic){.h = (float)h,
                    .inverse_h = (float)(1 / h),
                    .spacing = spacing,
                    .volume = (float)volume,
                    .value_scale = (float)value_scale,
                    .gradient_scale = (float)(value_scale / h),
                    .omega = (float)jacobi_damping(gradient, h),
                    .diffuse_moment = (float)(volume * sim_lattice_sum(diffuse_moment, spacing, h)),
                    .diffuse_degree = (float)(volume * sim_lattice_sum(diffuse_degree, spacing, h)),
                    .lattice_gradient = (float)gradient};
}
