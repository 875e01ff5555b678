// Wide floats: one type and a handful of functions, so that a kernel is written once and compiled for every instruction
// set (sim/wide/*.c are; see sim/CMakeLists.txt). Arithmetic is written with the plain operators + − * /, which
// GCC and Clang have for vector types.
//
// Same bytes on every instruction set: only operations that IEEE 754 rounds correctly are used (+ − * / and the square
// root, never a reciprocal estimate or a fused multiply-add), each lane is one particle of its own, and a lane's sums run
// in the order of its list. So a kernel's result does not depend on how many lanes work side by side.
#ifndef LIDO_SIM_WIDE_SIMD_H
#define LIDO_SIM_WIDE_SIMD_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "sim/wide/wide.h"

#define SIM_JOIN2(a, b) a##_##b
#define SIM_JOIN(a, b) SIM_JOIN2(a, b)
/// The name of a function of this compilation: WIDE(list_block) is list_block_avx2 …
#define WIDE(name) SIM_JOIN(name, SIM_ISA)

#if defined(SIM_ISA_AVX512)
#include <immintrin.h>
#define SIM_LANES 16
typedef __m512 SimF;

static inline SimF sim_f(float x) { return _mm512_set1_ps(x); }
static inline SimF sim_load(const float *p) { return _mm512_loadu_ps(p); }
static inline void sim_store(float *p, SimF a) { _mm512_storeu_ps(p, a); }
static inline SimF sim_sqrt(SimF a) { return _mm512_sqrt_ps(a); }
static inline SimF sim_max(SimF a, SimF b) { return _mm512_max_ps(a, b); }
static inline SimF sim_min(SimF a, SimF b) { return _mm512_min_ps(a, b); }
/// `chosen` where x < y, `other` elsewhere.
static inline SimF sim_select_less(SimF x, SimF y, SimF chosen, SimF other) {
  return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(x, y, _CMP_LT_OQ), other, chosen);
}
/// Two floats in the room of one: the upper 16 bits of each, that is, eight significant bits, cut off towards zero.
static inline SimF sim_halves(SimF upper, SimF lower) {
  __m512i high = _mm512_and_si512(_mm512_castps_si512(upper), _mm512_set1_epi32((int)0xffff0000u));
  return _mm512_castsi512_ps(_mm512_or_si512(high, _mm512_srli_epi32(_mm512_castps_si512(lower), 16)));
}
static inline SimF sim_upper_half(SimF pair) {
  return _mm512_castsi512_ps(_mm512_and_si512(_mm512_castps_si512(pair), _mm512_set1_epi32((int)0xffff0000u)));
}
static inline SimF sim_lower_half(SimF pair) {
  return _mm512_castsi512_ps(_mm512_slli_epi32(_mm512_castps_si512(pair), 16));
}

static inline void sim_transpose4(SimF r0, SimF r1, SimF r2, SimF r3, SimF out[4]) {
  SimF a = _mm512_unpacklo_ps(r0, r1), b = _mm512_unpackhi_ps(r0, r1), c = _mm512_unpacklo_ps(r2, r3),
       d = _mm512_unpackhi_ps(r2, r3);
  out[0] = _mm512_shuffle_ps(a, c, 0x44);
  out[1] = _mm512_shuffle_ps(a, c, 0xee);
  out[2] = _mm512_shuffle_ps(b, d, 0x44);
  out[3] = _mm512_shuffle_ps(b, d, 0xee);
}

static inline SimF sim_quad(const float *base, const uint32_t *index) {
  SimF r = _mm512_castps128_ps512(_mm_load_ps(base + 4 * (size_t)index[0]));
  r = _mm512_mask_broadcast_f32x4(r, 0x00f0, _mm_load_ps(base + 4 * (size_t)index[4]));
  r = _mm512_mask_broadcast_f32x4(r, 0x0f00, _mm_load_ps(base + 4 * (size_t)index[8]));
  return _mm512_mask_broadcast_f32x4(r, 0xf000, _mm_load_ps(base + 4 * (size_t)index[12]));
}
/// Four floats each from SIM_LANES places: out[c] lane k = base[4 · index[k] + c].
static inline void sim_gather4(const float *base, const uint32_t *index, SimF out[4]) {
  sim_transpose4(sim_quad(base, index), sim_quad(base, index + 1), sim_quad(base, index + 2), sim_quad(base, index + 3),
                 out);
}
/// The same from SIM_LANES places in a row.
static inline void sim_load4(const float *from, SimF out[4]) {
  const __m512i order = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
  SimF a = _mm512_permutexvar_ps(order, sim_load(from)), b = _mm512_permutexvar_ps(order, sim_load(from + 16)),
       c = _mm512_permutexvar_ps(order, sim_load(from + 32)), d = _mm512_permutexvar_ps(order, sim_load(from + 48));
  SimF ab02 = _mm512_shuffle_f32x4(a, b, 0x88), ab13 = _mm512_shuffle_f32x4(a, b, 0xdd),
       cd02 = _mm512_shuffle_f32x4(c, d, 0x88), cd13 = _mm512_shuffle_f32x4(c, d, 0xdd);
  out[0] = _mm512_shuffle_f32x4(ab02, cd02, 0x88);
  out[2] = _mm512_shuffle_f32x4(ab02, cd02, 0xdd);
  out[1] = _mm512_shuffle_f32x4(ab13, cd13, 0x88);
  out[3] = _mm512_shuffle_f32x4(ab13, cd13, 0xdd);
}
static inline void sim_store4(float *to, SimF x, SimF y, SimF z, SimF w) {
  SimF t[4];
  sim_transpose4(x, y, z, w, t); // 128-bit part p of t[k]: the four floats of particle 4p + k
  SimF a = _mm512_shuffle_f32x4(t[0], t[1], 0x44), b = _mm512_shuffle_f32x4(t[2], t[3], 0x44),
       c = _mm512_shuffle_f32x4(t[0], t[1], 0xee), d = _mm512_shuffle_f32x4(t[2], t[3], 0xee);
  sim_store(to, _mm512_shuffle_f32x4(a, b, 0x88));
  sim_store(to + 16, _mm512_shuffle_f32x4(a, b, 0xdd));
  sim_store(to + 32, _mm512_shuffle_f32x4(c, d, 0x88));
  sim_store(to + 48, _mm512_shuffle_f32x4(c, d, 0xdd));
}
/// Write first + k for every lane k.
static inline void sim_count_up(uint32_t *to, uint32_t first) {
  const __m512i steps = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  _mm512_storeu_si512(to, _mm512_add_epi32(_mm512_set1_epi32((int)first), steps));
}
/// Pack those of the SIM_LANES numbers where a < b, except `but`, together in order; writes SIM_LANES numbers. How many.
static inline uint32_t sim_pack_less(uint32_t *to, const uint32_t *from, SimF a, SimF b, uint32_t but) {
  __m512i number = _mm512_loadu_si512(from);
  __mmask16 other = _mm512_cmpneq_epi32_mask(number, _mm512_set1_epi32((int)but));
  __mmask16 mask = _mm512_mask_cmp_ps_mask(other, a, b, _CMP_LT_OQ);
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(mask, number));
  return (uint32_t)__builtin_popcount(mask);
}

#elif defined(SIM_ISA_AVX2)
#include <immintrin.h>
#define SIM_LANES 8
typedef __m256 SimF;

static inline SimF sim_f(float x) { return _mm256_set1_ps(x); }
static inline SimF sim_load(const float *p) { return _mm256_loadu_ps(p); }
static inline void sim_store(float *p, SimF a) { _mm256_storeu_ps(p, a); }
static inline SimF sim_sqrt(SimF a) { return _mm256_sqrt_ps(a); }
static inline SimF sim_max(SimF a, SimF b) { return _mm256_max_ps(a, b); }
static inline SimF sim_min(SimF a, SimF b) { return _mm256_min_ps(a, b); }
static inline SimF sim_select_less(SimF x, SimF y, SimF chosen, SimF other) {
  return _mm256_blendv_ps(other, chosen, _mm256_cmp_ps(x, y, _CMP_LT_OQ));
}
static inline SimF sim_halves(SimF upper, SimF lower) {
  __m256i high = _mm256_and_si256(_mm256_castps_si256(upper), _mm256_set1_epi32((int)0xffff0000u));
  return _mm256_castsi256_ps(_mm256_or_si256(high, _mm256_srli_epi32(_mm256_castps_si256(lower), 16)));
}
static inline SimF sim_upper_half(SimF pair) {
  return _mm256_castsi256_ps(_mm256_and_si256(_mm256_castps_si256(pair), _mm256_set1_epi32((int)0xffff0000u)));
}
static inline SimF sim_lower_half(SimF pair) {
  return _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_castps_si256(pair), 16));
}

static inline void sim_transpose4(SimF r0, SimF r1, SimF r2, SimF r3, SimF out[4]) {
  SimF a = _mm256_unpacklo_ps(r0, r1), b = _mm256_unpackhi_ps(r0, r1), c = _mm256_unpacklo_ps(r2, r3),
       d = _mm256_unpackhi_ps(r2, r3);
  out[0] = _mm256_shuffle_ps(a, c, 0x44);
  out[1] = _mm256_shuffle_ps(a, c, 0xee);
  out[2] = _mm256_shuffle_ps(b, d, 0x44);
  out[3] = _mm256_shuffle_ps(b, d, 0xee);
}

static inline SimF sim_quad(const float *base, const uint32_t *index) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(base + 4 * (size_t)index[0])),
                              _mm_load_ps(base + 4 * (size_t)index[4]), 1);
}
static inline void sim_gather4(const float *base, const uint32_t *index, SimF out[4]) {
  sim_transpose4(sim_quad(base, index), sim_quad(base, index + 1), sim_quad(base, index + 2), sim_quad(base, index + 3),
                 out);
}
static inline void sim_load4(const float *from, SimF out[4]) {
  SimF a = sim_load(from), b = sim_load(from + 8), c = sim_load(from + 16), d = sim_load(from + 24);
  sim_transpose4(_mm256_permute2f128_ps(a, c, 0x20), _mm256_permute2f128_ps(a, c, 0x31),
                 _mm256_permute2f128_ps(b, d, 0x20), _mm256_permute2f128_ps(b, d, 0x31), out);
}
static inline void sim_store4(float *to, SimF x, SimF y, SimF z, SimF w) {
  SimF t[4];
  sim_transpose4(x, y, z, w, t);
  sim_store(to, _mm256_permute2f128_ps(t[0], t[1], 0x20));
  sim_store(to + 8, _mm256_permute2f128_ps(t[2], t[3], 0x20));
  sim_store(to + 16, _mm256_permute2f128_ps(t[0], t[1], 0x31));
  sim_store(to + 24, _mm256_permute2f128_ps(t[2], t[3], 0x31));
}
static inline void sim_count_up(uint32_t *to, uint32_t first) {
  __m256i steps = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  _mm256_storeu_si256((__m256i *)to, _mm256_add_epi32(_mm256_set1_epi32((int)first), steps));
}
static inline uint32_t sim_pack_less(uint32_t *to, const uint32_t *from, SimF a, SimF b, uint32_t but) {
  __m256i number = _mm256_loadu_si256((const __m256i *)from);
  __m256 same = _mm256_castsi256_ps(_mm256_cmpeq_epi32(number, _mm256_set1_epi32((int)but)));
  uint32_t mask = (uint32_t)_mm256_movemask_ps(_mm256_andnot_ps(same, _mm256_cmp_ps(a, b, _CMP_LT_OQ)));
  // Where the set bits are, eight bits each: pdep spreads the mask, pext packs the numbers of its lanes.
  uint64_t lanes = _pext_u64(0x0706050403020100u, _pdep_u64(mask, 0x0101010101010101u) * 0xff);
  __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)lanes));
  _mm256_storeu_si256((__m256i *)to, _mm256_permutevar8x32_epi32(number, order));
  return (uint32_t)__builtin_popcount(mask);
}

#elif defined(SIM_ISA_SSE2)
#include <emmintrin.h>
#define SIM_LANES 4
typedef __m128 SimF;

static inline SimF sim_f(float x) { return _mm_set1_ps(x); }
static inline SimF sim_load(const float *p) { return _mm_loadu_ps(p); }
static inline void sim_store(float *p, SimF a) { _mm_storeu_ps(p, a); }
static inline SimF sim_sqrt(SimF a) { return _mm_sqrt_ps(a); }
static inline SimF sim_max(SimF a, SimF b) { return _mm_max_ps(a, b); }
static inline SimF sim_min(SimF a, SimF b) { return _mm_min_ps(a, b); }
static inline SimF sim_select_less(SimF x, SimF y, SimF chosen, SimF other) {
  __m128 less = _mm_cmplt_ps(x, y);
  return _mm_or_ps(_mm_and_ps(less, chosen), _mm_andnot_ps(less, other));
}
static inline SimF sim_halves(SimF upper, SimF lower) {
  __m128i high = _mm_and_si128(_mm_castps_si128(upper), _mm_set1_epi32((int)0xffff0000u));
  return _mm_castsi128_ps(_mm_or_si128(high, _mm_srli_epi32(_mm_castps_si128(lower), 16)));
}
static inline SimF sim_upper_half(SimF pair) {
  return _mm_castsi128_ps(_mm_and_si128(_mm_castps_si128(pair), _mm_set1_epi32((int)0xffff0000u)));
}
static inline SimF sim_lower_half(SimF pair) {
  return _mm_castsi128_ps(_mm_slli_epi32(_mm_castps_si128(pair), 16));
}
static inline void sim_transpose4(SimF r0, SimF r1, SimF r2, SimF r3, SimF out[4]) {
  _MM_TRANSPOSE4_PS(r0, r1, r2, r3);
  out[0] = r0, out[1] = r1, out[2] = r2, out[3] = r3;
}
static inline void sim_gather4(const float *base, const uint32_t *index, SimF out[4]) {
  sim_transpose4(_mm_load_ps(base + 4 * (size_t)index[0]), _mm_load_ps(base + 4 * (size_t)index[1]),
                 _mm_load_ps(base + 4 * (size_t)index[2]), _mm_load_ps(base + 4 * (size_t)index[3]), out);
}
static inline void sim_load4(const float *from, SimF out[4]) {
  sim_transpose4(sim_load(from), sim_load(from + 4), sim_load(from + 8), sim_load(from + 12), out);
}
static inline void sim_store4(float *to, SimF x, SimF y, SimF z, SimF w) {
  SimF t[4];
  sim_transpose4(x, y, z, w, t);
  for (int k = 0; k < 4; k++) sim_store(to + 4 * k, t[k]);
}
static inline void sim_count_up(uint32_t *to, uint32_t first) {
  for (uint32_t k = 0; k < 4; k++) to[k] = first + k;
}
static inline uint32_t sim_pack_less(uint32_t *to, const uint32_t *from, SimF a, SimF b, uint32_t but) {
  uint32_t mask = (uint32_t)_mm_movemask_ps(_mm_cmplt_ps(a, b)), count = 0;
  for (uint32_t k = 0; k < 4; k++) {
    to[count] = from[k]; // overwritten unless it is counted
    count += (mask >> k & 1) & (from[k] != but);
  }
  return count;
}

#else
#define SIM_LANES 1
typedef float SimF;

static inline SimF sim_f(float x) { return x; }
static inline SimF sim_load(const float *p) { return *p; }
static inline void sim_store(float *p, SimF a) { *p = a; }
static inline SimF sim_sqrt(SimF a) { return sqrtf(a); }
static inline SimF sim_max(SimF a, SimF b) { return a > b ? a : b; }
static inline SimF sim_min(SimF a, SimF b) { return a < b ? a : b; }
static inline SimF sim_select_less(SimF x, SimF y, SimF chosen, SimF other) { return x < y ? chosen : other; }
static inline uint32_t sim_bits(SimF a) {
  uint32_t bits;
  memcpy(&bits, &a, sizeof bits);
  return bits;
}
static inline SimF sim_from_bits(uint32_t bits) {
  SimF a;
  memcpy(&a, &bits, sizeof a);
  return a;
}
static inline SimF sim_halves(SimF upper, SimF lower) {
  return sim_from_bits((sim_bits(upper) & 0xffff0000u) | sim_bits(lower) >> 16);
}
static inline SimF sim_upper_half(SimF pair) { return sim_from_bits(sim_bits(pair) & 0xffff0000u); }
static inline SimF sim_lower_half(SimF pair) { return sim_from_bits(sim_bits(pair) << 16); }
static inline void sim_load4(const float *from, SimF out[4]) {
  for (int c = 0; c < 4; c++) out[c] = from[c];
}
static inline void sim_gather4(const float *base, const uint32_t *index, SimF out[4]) {
  sim_load4(base + 4 * (size_t)*index, out);
}
static inline void sim_store4(float *to, SimF x, SimF y, SimF z, SimF w) {
  to[0] = x, to[1] = y, to[2] = z, to[3] = w;
}
static inline void sim_count_up(uint32_t *to, uint32_t first) { *to = first; }
static inline uint32_t sim_pack_less(uint32_t *to, const uint32_t *from, SimF a, SimF b, uint32_t but) {
  *to = *from;
  return a < b && *from != but;
}
#endif

#endif
