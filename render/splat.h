// Particles drawn as spheres by casting each pixel's ray at them: the passes that styles share.
#ifndef LIDO_RENDER_SPLAT_H
#define LIDO_RENDER_SPLAT_H

#include "render/picture.h"

/// The nearest spheres. Needs: none. Writes two colours and the depth of `out`:
/// 0: outward unit normal in world axes, depth along the view axis (m), all 0 where there is no sphere;
/// 1: colour of the particle, spray.
bool render_splat_surface(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                          RenderError *error);

/// Metres of water along each pixel's ray up to the background, added to `out`, which may be smaller than the picture.
/// Chords are scaled so that all spheres together hold the volume of the water, however much they overlap.
bool render_splat_thickness(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                            RenderError *error);

/// Metres of water along each pixel's ray up to the background, from spheres (vec4 each: centre and radius, m), each spread as
/// a Gaussian over the picture (Green 2010; Rocha Neto et al. 2014, section III-C), added to red of `out`, which may be
/// smaller.
bool render_splat_gaussians(RenderPicture *picture, GpuProgram *program, const GpuBuffer *spheres, int32_t count,
                            const GpuTarget *out, RenderError *error);

/// The colour of the water at its surface: metres as above, weighed less the farther they are behind it, times the colours of
/// their spheres (vec4 each, linear) in red, green and blue, alone in alpha. `surface` has 1 / depth in its red.
bool render_splat_colours(RenderPicture *picture, GpuProgram *program, const GpuBuffer *spheres,
                          const GpuBuffer *colours, int32_t count, const GpuTexture *surface, const GpuTarget *out,
                          RenderError *error);

/// Of all particles along the sun's rays, over the sun map: thickness (m) in red; in alpha the height towards the sun (m) of the
/// nearest water, -1e9 where there is none.
bool render_splat_sun(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                      RenderError *error);

#endif
