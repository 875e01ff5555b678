// The one table of everything that a scene may say. From it come the structs of scene.h, the parser, what `lido check`
// prints, configs/scene.schema.json and docs/scene.md, so they cannot disagree.
//
// One macro per JSON object; it takes what to do with each kind of row, and the name S of the struct it fills:
//   F(S, type, key, unit, range, default, doc)   a value; `default` is JSON text, SCENE_REQUIRED when there is none
//   O(S, Struct, key, doc)                       an object
//   L(S, Struct, key, limit, doc)                a list of at most `limit` objects: pointer `key` and `key_count`
//   V(S, NAME, key, Struct, doc)                 fields that an item has when its "type" is `key`, kept in member `key`
//
// type      in C                          in JSON                                          range
// NUMBER    float                         number                                           interval
// REAL      double                        number                                           interval
// INTEGER   int32_t                       whole number                                     interval
// SEED      uint64_t                      whole number                                     interval
// SWITCH    bool                          true, false                                      –
// TEXT      char[SCENE_TEXT_SIZE]         string                                           –
// CHOICE    int32_t, place in the range   string                                           "a | b | c"
// STYLE     char[SCENE_TEXT_SIZE]         string, a style of the renderer                  –
// VECTOR    float[3]                      three numbers                                    interval of each
// DIRECTION float[3], kept as given       three numbers, not all zero                      interval of each
// OPTIONAL  float, NAN for null           number or null                                   interval
// OPTIONAL_REAL double, NAN for null      number or null                                   interval
// OPTIONAL_PAIR float[2], NANs for null   two numbers or null                              interval of each
// OPTIONAL_VECTOR float[3], NANs for null three numbers or null                            interval of each
// REFERENCE SceneReference                name or place of an item; null where the default is null; the list
#ifndef LIDO_APP_SCENE_FIELDS_H
#define LIDO_APP_SCENE_FIELDS_H

#include <stddef.h>

#define SCENE_REQUIRED NULL

// clang-format off
#define SCENE_TOP(F, O, L, V, S) \
  F(S, INTEGER,   version,         "",         "[1, 1]",           SCENE_REQUIRED, \
    "Version of this format.") \
  F(S, TEXT,      name,            "",         "",                 "\"\"", \
    "What people call the scene.") \
  O(S, SceneSimulation,  simulation,        "How the water moves.") \
  O(S, SceneContainer,   container,         "What holds the water.") \
  L(S, SceneFluid,       fluid,      4096,  "The water: at the start, where items must not overlap, and from spouts.") \
  L(S, SceneSink,        sinks,      1024,  "Boxes that swallow the particles whose centres enter them.") \
  L(S, SceneObstacle,    obstacles,  1024,  "Solid bodies in the water.") \
  O(S, SceneCamera,      camera,            "Where the eye is.") \
  O(S, SceneLight,       light,             "The sun.") \
  O(S, SceneEnvironment, environment,       "What is around the water.") \
  O(S, SceneRender,      render,            "How the picture is made. Colours are linear light.") \
  L(S, SceneEvent,       events,     65536, "A timeline of what a hand would do; sorted by time when read.")

#define SCENE_SIMULATION(F, O, L, V, S) \
  F(S, CHOICE,    solver,          "",         "pbf | sph",        "\"pbf\"", \
    "Method: pbf, position based fluids; sph, smoothed particle hydrodynamics.") \
  F(S, NUMBER,    particle_radius, "m",        "[0.0001, 1]",      "0.0175", \
    "Half the spacing of the particles at rest.") \
  F(S, NUMBER,    rest_density,    "kg/m³",    "[1, 100000]",      "1000", \
    "Density of the liquid.") \
  F(S, NUMBER,    support,         "spacings", "[1.5, 3]",         "2", \
    "Support radius of the kernels.") \
  F(S, VECTOR,    gravity,         "m/s²",     "[-1000, 1000]",    "[0, -9.81, 0]", \
    "Gravity at the start.") \
  F(S, NUMBER,    time_step,       "s",        "[0, 0.1]",         "0", \
    "Longest substep; 0: adaptive, from cfl.") \
  F(S, NUMBER,    cfl,             "spacings", "[0.05, 2]",        "1.1", \
    "Adaptive step: how far the fastest particle may move in one substep; in free flight half as far again.") \
  F(S, INTEGER,   iterations,      "",         "[1, 100]",         "4", \
    "Density iterations a substep.") \
  F(S, NUMBER,    viscosity,       "",         "[0, 0.5]",         "0.04", \
    "XSPH factor: how much neighbours share their velocity.") \
  F(S, NUMBER,    kinematic_viscosity, "m²/s", "[0, 10]",          "1e-6", \
    "How thick the liquid is; the default is water's.") \
  F(S, NUMBER,    surface_tension, "N/m",      "[0, 10]",          "0", \
    "Pulls the surface together.") \
  F(S, NUMBER,    vorticity,       "",         "[0, 1]",           "0", \
    "Vorticity confinement: keeps eddies alive.") \
  F(S, NUMBER,    relaxation,      "",         "[0.001, 10]",      "0.1", \
    "Softness of the density constraint (PBF); larger is softer and steadier.") \
  F(S, NUMBER,    tensile,         "",         "[0, 0.1]",         "0", \
    "Artificial pressure against clumping at the surface (PBF).") \
  F(S, INTEGER,   max_particles,   "",         "[0, 16777216]",    "0", \
    "Emitters and pouring stop there; 0: as many as there can be, 16777216.") \
  F(S, SWITCH,    reuse,           "",         "",                 "false", \
    "At max_particles, emitters take away the particles that were emitted first.") \
  F(S, NUMBER,    colour_diffusion, "m²/s",    "[0, 10]",          "0", \
    "How fast the colours of neighbouring water mix.") \
  F(S, REAL,      duration,        "s",        "(0, 3600]",        "6", \
    "How long the scene lasts when it is recorded.") \
  F(S, SEED,      seed,            "",         "[0, 9007199254740991]", "1", \
    "Of every random choice.") \
  F(S, NUMBER,    jitter,          "spacings", "[0, 0.5]",         "0", \
    "Random displacement of the particles at the start.")

#define SCENE_CONTAINER(F, O, L, V, S) \
  F(S, CHOICE,    shape,           "",         "box | glass",      "\"box\"", \
    "box, or glass: an upright cylinder around its middle, as wide as its shorter side; open at the top for the eye.") \
  F(S, VECTOR,    min,             "m",        "[-1000, 1000]",    "[0, 0, 0]", \
    "Lowest corner of the inner walls.") \
  F(S, VECTOR,    max,             "m",        "[-1000, 1000]",    "[3, 1.6, 1]", \
    "Highest corner of the inner walls.") \
  F(S, NUMBER,    friction,        "",         "[0, 1]",           "0", \
    "Share of the sliding speed that its walls take from the water beside them; 0 slips, 1 sticks.") \
  F(S, SWITCH,    visible,         "",         "",                 "true", \
    "Whether its edges are drawn.")

#define SCENE_FLUID(F, O, L, V, S) \
  F(S, CHOICE,    type,            "",         "block | drop | emitter | ripple", "\"block\"", \
    "What kind of water this is.") \
  V(S, BLOCK,     block,           SceneBlock,   "A box filled with particles.") \
  V(S, DROP,      drop,            SceneDrop,    "A ball filled with particles.") \
  V(S, EMITTER,   emitter,         SceneEmitter, \
    "A spout: layers of particles leave its opening, as many as its size and speed make; none where it is blocked.") \
  V(S, RIPPLE,    ripple,          SceneRipple, \
    "Water without particles, from wall to wall: its surface is a sum of waves. It stands alone; style heightfield shows it.")

#define SCENE_BLOCK(F, O, L, V, S) \
  F(S, VECTOR,    min,             "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Lowest corner.") \
  F(S, VECTOR,    max,             "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Highest corner.") \
  F(S, VECTOR,    velocity,        "m/s",      "[-1000, 1000]",    "[0, 0, 0]", \
    "Velocity at the start.") \
  F(S, VECTOR,    colour,          "linear",   "[0, 1]",           "[0, 0, 0]", \
    "Colour of the water; all 0: the natural one.")

#define SCENE_DROP(F, O, L, V, S) \
  F(S, VECTOR,    centre,          "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Its middle.") \
  F(S, NUMBER,    radius,          "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Its radius.") \
  F(S, VECTOR,    velocity,        "m/s",      "[-1000, 1000]",    "[0, 0, 0]", \
    "Velocity at the start.") \
  F(S, VECTOR,    colour,          "linear",   "[0, 1]",           "[0, 0, 0]", \
    "Colour of the water; all 0: the natural one.")

#define SCENE_EMITTER(F, O, L, V, S) \
  F(S, TEXT,      name,            "",         "",                 "\"\"", \
    "What events call it.") \
  F(S, CHOICE,    shape,           "",         "disc | rectangle", "\"disc\"", \
    "Of the opening.") \
  F(S, OPTIONAL,  diameter,        "m",        "(0, 1000]",        "null", \
    "Of a disc, which needs it.") \
  F(S, OPTIONAL_PAIR, size,        "m",        "(0, 1000]",        "null", \
    "Of a rectangle, which needs it: full widths along up and across it.") \
  F(S, VECTOR,    position,        "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "The middle of the opening; in the axes of the obstacle that carries it.") \
  F(S, DIRECTION, direction,       "",         "[-1000, 1000]",    SCENE_REQUIRED, \
    "Where the water leaves to; any length.") \
  F(S, DIRECTION, up,              "",         "[-1000, 1000]",    "[0, 1, 0]", \
    "Rolls a rectangle: its first side goes along up, as nearly as direction lets it; if they are parallel, along x.") \
  F(S, NUMBER,    speed,           "m/s",      "[0.01, 100]",      "1", \
    "Of the water that leaves, on top of the obstacle's.") \
  F(S, REAL,      start,           "s",        "[0, 3600]",        "0", \
    "When it begins to run.") \
  F(S, OPTIONAL_REAL, stop,        "s",        "[0, 3600]",        "null", \
    "When it ends; null: never.") \
  F(S, VECTOR,    colour,          "linear",   "[0, 1]",           "[0, 0, 0]", \
    "Colour of the water; all 0: the natural one.") \
  F(S, REFERENCE, obstacle,        "",         "obstacles",        "null", \
    "The obstacle that carries it; null: it stands still.")

#define SCENE_RIPPLE(F, O, L, V, S) \
  F(S, NUMBER,    level,           "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Height (y) of the water at rest; waves may reach neither the floor nor the container's upper end.") \
  L(S, SceneWave, waves,     64,    "What the surface is the sum of: small waves, as fast as gravity makes them on water of this depth.")

#define SCENE_WAVE(F, O, L, V, S) \
  F(S, NUMBER,    amplitude,       "m",        "[0, 1000]",        SCENE_REQUIRED, \
    "Half the height from trough to crest.") \
  F(S, NUMBER,    wavelength,      "m",        "(0, 1000000]",     SCENE_REQUIRED, \
    "From crest to crest; at least twice the particle_radius.") \
  F(S, DIRECTION, direction,       "",         "[-1000, 1000]",    "[1, 0, 0]", \
    "Where it goes to, level; any length.") \
  F(S, NUMBER,    phase,           "degrees",  "[-360, 360]",      "0", \
    "Of its cosine, at the origin when the scene starts.") \
  F(S, SWITCH,    standing,        "",         "",                 "false", \
    "It swings where it is instead of travelling.")

#define SCENE_SINK(F, O, L, V, S) \
  F(S, VECTOR,    min,             "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Lowest corner.") \
  F(S, VECTOR,    max,             "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Highest corner.")

#define SCENE_KEY(F, O, L, V, S) \
  F(S, REAL,      time,            "s",        "[0, 3600]",        SCENE_REQUIRED, \
    "When it is there; later than the key before.") \
  F(S, VECTOR,    position,        "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Its centre then.") \
  F(S, VECTOR,    rotation,        "degrees",  "[-360, 360]",      "[0, 0, 0]", \
    "Turned about x, then y, then z; from key to key it turns the short way.")

#define SCENE_OBSTACLE(F, O, L, V, S) \
  F(S, CHOICE,    type,            "",         "box | sphere | cylinder | capsule | stairs | mesh", SCENE_REQUIRED, \
    "Shape of the body.") \
  F(S, TEXT,      name,            "",         "",                 "\"\"", \
    "What emitters and events call it.") \
  F(S, CHOICE,    motion,          "",         "static | scripted | draggable | floating", "\"static\"", \
    "static: it stands; scripted: by keys and stroke; draggable: by mouse and drag events; floating: the water carries it.") \
  F(S, VECTOR,    position,        "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Its centre.") \
  F(S, VECTOR,    rotation,        "degrees",  "[-360, 360]",      "[0, 0, 0]", \
    "Turned about x, then y, then z.") \
  F(S, VECTOR,    colour,          "linear",   "[0, 1]",           "[0.75, 0.72, 0.68]", \
    "Its colour.") \
  F(S, NUMBER,    friction,        "",         "[0, 1]",           "0", \
    "Share of the sliding speed that it takes from the water beside it; 0 slips, 1 sticks.") \
  L(S, SceneKey,  keys,       4096,  "Scripted: where it is and when; between keys it moves evenly.") \
  F(S, SWITCH,    repeat,          "",         "",                 "false", \
    "Scripted: the keys start again after the last one.") \
  F(S, VECTOR,    stroke,          "m",        "[-1000, 1000]",    "[0, 0, 0]", \
    "Scripted: swings, like a wave paddle, from where it is to this far away and back.") \
  F(S, NUMBER,    period,          "s",        "(0, 3600]",        "1", \
    "Scripted: of the stroke, there and back.") \
  F(S, REAL,      start,           "s",        "[0, 3600]",        "0", \
    "Scripted: when the stroke begins.") \
  F(S, NUMBER,    max_speed,       "m/s",      "(0, 100]",         "1", \
    "Draggable: it follows the hand no faster.") \
  F(S, NUMBER,    density,         "kg/m³",    "(0, 100000]",      "500", \
    "Floating: its mass by its volume; less than the liquid's floats.") \
  V(S, BOX,       box,             SceneBox,      "A box.") \
  V(S, SPHERE,    sphere,          SceneSphere,   "A ball.") \
  V(S, CYLINDER,  cylinder,        SceneCylinder, "A cylinder, upright before it is turned.") \
  V(S, CAPSULE,   capsule,         SceneCapsule,  "A cylinder with half balls at its ends, upright before it is turned.") \
  V(S, STAIRS,    stairs,          SceneStairs,   "A solid flight of stairs that climbs towards +x before it is turned.") \
  V(S, MESH,      mesh,            SceneMesh,     "A closed triangle mesh from a file.")

#define SCENE_BOX(F, O, L, V, S) \
  F(S, VECTOR,    size,            "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Full edge lengths.")

#define SCENE_SPHERE(F, O, L, V, S) \
  F(S, NUMBER,    radius,          "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Its radius.")

#define SCENE_CYLINDER(F, O, L, V, S) \
  F(S, NUMBER,    radius,          "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Its radius.") \
  F(S, NUMBER,    height,          "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Its height.")

#define SCENE_CAPSULE(F, O, L, V, S) \
  F(S, NUMBER,    radius,          "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Its radius.") \
  F(S, NUMBER,    height,          "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Its full height, at least twice the radius.")

#define SCENE_STAIRS(F, O, L, V, S) \
  F(S, VECTOR,    size,            "m",        "(0, 1000]",        SCENE_REQUIRED, \
    "Full length, height and width of the flight.") \
  F(S, INTEGER,   steps,           "",         "[1, 1000]",        SCENE_REQUIRED, \
    "Number of steps.")

#define SCENE_MESH(F, O, L, V, S) \
  F(S, TEXT,      file,            "",         "",                 SCENE_REQUIRED, \
    "Relative to the scene's file: OBJ, PLY, STL, OFF, GLB, DAE, FBX or 3DS; one closed surface, at most 64 MiB and 500000 triangles.") \
  F(S, NUMBER,    scale,           "",         "(0, 1000000]",     "1", \
    "From the file's lengths to metres.") \
  F(S, SWITCH,    centre,          "",         "",                 "true", \
    "The middle of its box is its centre; false: the file's origin is.")

#define SCENE_CAMERA(F, O, L, V, S) \
  F(S, OPTIONAL_VECTOR, eye,       "m",        "[-10000, 10000]",  "null", \
    "Position of the eye; null: in front of the container and above it.") \
  F(S, OPTIONAL_VECTOR, target,    "m",        "[-10000, 10000]",  "null", \
    "The point looked at; null: in the lower half of the container.") \
  F(S, NUMBER,    fov,             "degrees",  "(1, 170)",         "38", \
    "Full vertical angle of view; 38 is a lens of about 35 mm.")

#define SCENE_LIGHT(F, O, L, V, S) \
  F(S, DIRECTION, direction,       "",         "[-1000, 1000]",    "[-0.45, 0.75, 0.5]", \
    "Towards the sun; any length.") \
  F(S, VECTOR,    colour,          "linear",   "[0, 1000]",        "[3.8, 3.5, 3]", \
    "Irradiance of the sun.") \
  F(S, SWITCH,    sun,             "",         "",                 "true", \
    "Off: neither sunlight nor glints.") \
  F(S, SWITCH,    shadow,          "",         "",                 "true", \
    "Whether things cast shadows.")

#define SCENE_ENVIRONMENT(F, O, L, V, S) \
  F(S, CHOICE,    sky,             "",         "clear | gradient", "\"clear\"", \
    "A clear day, or exactly two colours mixed by the height of the direction.") \
  F(S, VECTOR,    sky_zenith,      "linear",   "[0, 1000]",        "[0.15, 0.35, 0.75]", \
    "Gradient: the colour overhead.") \
  F(S, VECTOR,    sky_horizon,     "linear",   "[0, 1000]",        "[0.8, 0.88, 0.95]", \
    "Gradient: the colour at and below the horizon.") \
  F(S, CHOICE,    floor,           "",         "tiles | checker | none", "\"tiles\"", \
    "Pale tiles with fine grout, exactly two unlit colours, or no floor at all.") \
  F(S, OPTIONAL,  floor_level,     "m",        "[-1000, 1000]",    "null", \
    "Height of the floor; null: the bottom of the container.") \
  F(S, NUMBER,    tile_size,       "m",        "[0.001, 1000]",       "0.2", \
    "Edge of a tile or of a checker square.") \
  F(S, VECTOR,    checker_even,    "linear",   "[0, 1000]",        "[0.8, 0.8, 0.8]", \
    "Checker: colour where floor(x/size) + floor(z/size) is even.") \
  F(S, VECTOR,    checker_odd,     "linear",   "[0, 1000]",        "[0.2, 0.2, 0.2]", \
    "Checker: colour elsewhere.")

#define SCENE_RENDER(F, O, L, V, S) \
  F(S, STYLE,     style,           "",         "",                 "\"refraction\"", \
    "How the water is drawn.") \
  F(S, CHOICE,    tone_map,        "",         "none | filmic",    "\"filmic\"", \
    "none: pictures hold 255 × the linear value, for measurements.") \
  F(S, NUMBER,    exposure,        "",         "[0.001, 1000]",       "1", \
    "Factor before the tone curve.") \
  F(S, CHOICE,    material,        "", "water | milk | juice | oil | cola | ink | metal | gold | copper", "\"water\"", \
    "What the liquid is: it brings the next four values, where they are not given.") \
  F(S, VECTOR,    absorption,      "1/m",      "[0, 10000]",       "[3.2, 0.68, 0.46]", \
    "How strongly the water takes away red, green and blue light.") \
  F(S, VECTOR,    scattering,      "1/m",      "[0, 10000]",       "[0.14, 0.34, 0.36]", \
    "How strongly it turns light aside (styles points and raycast).") \
  F(S, VECTOR,    reflectance,     "linear",   "[0, 1]",           "[0, 0, 0]", \
    "Of a metal at normal incidence; 0: it lets light through (style raycast).") \
  F(S, NUMBER,    refractive_index, "",        "[1, 3]",           "1.333", \
    "Of the water.") \
  O(S, SceneRefraction, refraction, "The style refraction (Imai, Kanamori, Mitani 2016).") \
  O(S, SceneRaycast, raycast,      "The style raycast (Xiao, Zhang, Yang 2017).") \
  O(S, SceneCartoon, cartoon,      "The style cartoon (Rocha Neto, Guimarães, Apolinário, Mello 2014).") \
  O(S, SceneHeightfield, heightfield, "The style heightfield (Cords 2007).") \
  O(S, ScenePoints, points,        "The style points.")

#define SCENE_REFRACTION(F, O, L, V, S) \
  F(S, INTEGER,   count,           "",         "[1, 4]",           "4", \
    "How often a ray is bent at most: 1, into the water; 2, out of it; 3 and 4, into and out of what lies behind.") \
  F(S, NUMBER,    scale,           "",         "[0.5, 2]",         "1.2", \
    "Of the ellipsoids; 1: as in the paper, where no semi-axis is longer than 1.2 radii.") \
  F(S, NUMBER,    lift,            "radii",    "[0, 2]",           "0.8", \
    "How far ellipsoids at the surface are moved outwards, to the level that their smoothed centres have left; 0: as in the paper.") \
  F(S, CHOICE,    smoothing,       "", "regression | plane_fit | bilateral | narrow_range | none", "\"regression\"", \
    "Filter of the depth maps: lines through the inverse depth; the paper's planes; Imai 2014; Truong & Yuksel 2018.") \
  F(S, NUMBER,    sigma,           "radii",    "[0.001, 100]",     "5.3", \
    "plane_fit (Eq. 2), bilateral: differences in depth that still count as one surface.") \
  F(S, INTEGER,   window,          "",         "[3, 63]",          "9", \
    "plane_fit, bilateral: taps across the window, odd; an even number is one less than it makes.") \
  F(S, NUMBER,    reach,           "radii",    "[0, 50]",          "0", \
    "plane_fit: half of the window, the same in the world however far it is; 0: the taps are neighbouring pixels.") \
  F(S, INTEGER,   iterations,      "",         "[1, 50]",          "2", \
    "plane_fit, bilateral, narrow_range: how often.") \
  F(S, SWITCH,    view_dependent,  "",         "",                 "true", \
    "plane_fit: weights by depth (Eq. 2); off: by distance (section 5).") \
  F(S, SWITCH,    splashes_apart,  "",         "",                 "true", \
    "Splashes have depth maps of their own; off: one surface for all, as in Imai 2014.") \
  F(S, SWITCH,    surface_only,    "",         "",                 "true", \
    "Draw only the particles near the surface; off: all, which looks the same.")

#define SCENE_RAYCAST(F, O, L, V, S) \
  F(S, NUMBER,    iso,             "",         "[0.01, 0.99]",     "0.25", \
    "Value of the density field at the surface, in that of water at rest; the paper's 10 to 30 are 0.125 to 0.375.") \
  F(S, NUMBER,    support,         "radii",    "[2, 8]",           "4", \
    "Of the field's kernel (Eq. 1).") \
  F(S, CHOICE,    normals,         "",         "blend | gradient | pca", "\"blend\"", \
    "blend: PCA (Eqs. 3, 4) as far as it agrees with the gradient (Eq. 2), by Eqs. 5 and 6; or one of them alone.") \
  F(S, NUMBER,    normal_reach,    "radii",    "[2, 12]",          "6", \
    "R of Eqs. 2 to 4; the paper's 3 spacings are 6 radii.") \
  F(S, NUMBER,    blend_d,         "",         "[0, 1000]",        "10", \
    "d of Eq. 6.") \
  F(S, NUMBER,    blend_k,         "",         "[-1, 1]",          "0.998", \
    "k of Eq. 6.") \
  F(S, NUMBER,    blend_weight,    "",         "[-1, 1]",          "-1", \
    "w of Eq. 5 as one number for all; negative: by Eq. 6.") \
  F(S, NUMBER,    filter_reach,    "radii",    "[0, 20]",          "3", \
    "Half of the window of the bilateral filter of normals; 0: no filter.") \
  F(S, NUMBER,    filter_angle,    "",         "[0.001, 2]",       "0.2", \
    "Standard deviation of the normals in it, as the length of their difference.")

#define SCENE_CARTOON(F, O, L, V, S) \
  F(S, CHOICE,    palette,         "",         "lagoon | ink | lava | storm", "\"lagoon\"", \
    "The colours of the drawing, and most_reflection and most_transparency: what is null here is the palette's.") \
  F(S, NUMBER,    scale,           "radii",    "[0.5, 4]",         "1.5", \
    "Radius of the spheres drawn, in particle radii.") \
  F(S, CHOICE,    smoothing,       "", "bilateral | curvature_flow | none", "\"bilateral\"", \
    "Filter of the depth map: bilateral (Eqs. 1, 2), or curvature flow (van der Laan, Green, Sainz 2009).") \
  F(S, INTEGER,   kernel,          "pixels",   "[0, 63]",          "0", \
    "bilateral: size of the kernel in pixels of the depth map; 0: by reach, so that it grows as the water comes closer.") \
  F(S, NUMBER,    reach,           "radii",    "[0, 50]",          "12", \
    "Half of the size of the adaptive kernel, and of what curvature flow smooths.") \
  F(S, SWITCH,    separated,       "",         "",                 "false", \
    "bilateral: along rows, then along columns; off: the full kernel.") \
  F(S, SWITCH,    fitted,          "",         "",                 "true", \
    "bilateral: planes fitted by its weights, so that slanted water keeps its slope up to its borders; off: means, as in the paper.") \
  F(S, NUMBER,    range,           "radii",    "[0.001, 100]",     "4", \
    "bilateral: differences in depth that still count as one surface.") \
  F(S, SWITCH,    half_resolution, "",         "",                 "true", \
    "Depth, thickness and normals at half the picture's resolution.") \
  F(S, SWITCH,    splashes_apart,  "",         "",                 "true", \
    "Drops are drawn by themselves and smear no surface; off: as in the paper.") \
  F(S, INTEGER,   levels,          "",         "[1, 32]",          "3", \
    "l of Eq. 6: levels of light.") \
  F(S, SWITCH,    bright_levels,   "",         "",                 "true", \
    "Eq. 6 with the ceiling, slightly brighter; off: with the floor.") \
  F(S, SWITCH,    steady,          "",         "",                 "true", \
    "Levels are shifted so that still water lies in the middle of one and does not flicker; off: as in the paper.") \
  F(S, NUMBER,    bright_threshold, "",        "[0, 1]",           "0.85", \
    "T_bc of Eq. 7: brighter levels are made brighter still.") \
  F(S, NUMBER,    dark_threshold,  "",         "[0, 1]",           "0.5", \
    "T_dc of Eq. 7: darker levels are made darker still.") \
  F(S, NUMBER,    bright_factor,   "",         "[1, 10]",          "1.1", \
    "F_bc of Eq. 7.") \
  F(S, NUMBER,    dark_factor,     "",         "[0, 1]",           "0.9", \
    "F_dc of Eq. 7.") \
  F(S, SWITCH,    reflection,      "",         "",                 "true", \
    "Whether the water mirrors its surroundings.") \
  F(S, SWITCH,    refraction,      "",         "",                 "true", \
    "Whether the scene behind is seen through the water.") \
  F(S, OPTIONAL,  most_reflection, "",         "[0, 1]",           "null", \
    "K_Rmax of Eq. 4: of water that is grazed.") \
  F(S, NUMBER,    least_reflection, "",        "[0, 1]",           "0", \
    "K_Rmin: of water that faces the eye.") \
  F(S, OPTIONAL,  most_transparency, "",       "[0, 1]",           "null", \
    "K_Tmax of Eq. 5: of water that faces the eye.") \
  F(S, NUMBER,    least_transparency, "",      "[0, 1]",           "0", \
    "K_Tmin: of water that is grazed.") \
  F(S, NUMBER,    critical_angle,  "degrees",  "[0, 90]",          "60", \
    "θ_c: the angle between normal and view at which transparency gives way to reflection.") \
  F(S, NUMBER,    angle_interval,  "degrees",  "[0, 90]",          "20", \
    "θ_s: how far on either side of it they change over.") \
  F(S, NUMBER,    clearness,       "m",        "[0, 1000000]",     "0", \
    "Water through which a share of 1/e of what is behind is seen (Eq. 8); 0: a twelfth of the scene's size.") \
  F(S, NUMBER,    bending,         "",         "[-10, 10]",        "0.3", \
    "λ of Eq. 10: how far what is behind is displaced for each metre of water.") \
  F(S, NUMBER,    outline,         "pixels",   "[0, 16]",          "3", \
    "Width of outlines; 0: none.") \
  F(S, NUMBER,    crease_angle,    "degrees",  "[0, 180]",         "40", \
    "Edges sharper than this are outlined.") \
  F(S, OPTIONAL_VECTOR, dark,      "linear",   "[0, 1]",           "null", \
    "Colour of the water in full light (C_f of Eq. 8) where Eq. 7 makes it darker.") \
  F(S, OPTIONAL_VECTOR, medium,    "linear",   "[0, 1]",           "null", \
    "The same where Eq. 7 leaves it.") \
  F(S, OPTIONAL_VECTOR, bright,    "linear",   "[0, 1]",           "null", \
    "The same where Eq. 7 makes it brighter.") \
  F(S, OPTIONAL_VECTOR, splash,    "linear",   "[0, 1]",           "null", \
    "Colour of drops in the light.") \
  F(S, OPTIONAL_VECTOR, splash_dark, "linear", "[0, 1]",           "null", \
    "Colour of drops away from it.") \
  F(S, OPTIONAL_VECTOR, ink,       "linear",   "[0, 1]",           "null", \
    "Colour of outlines.") \
  F(S, OPTIONAL_VECTOR, shade,     "linear",   "[0, 1]",           "null", \
    "What shadow leaves of the colours of floor and obstacles.") \
  F(S, OPTIONAL_VECTOR, sky_top,   "linear",   "[0, 1]",           "null", \
    "Colour of the sky overhead.") \
  F(S, OPTIONAL_VECTOR, sky_middle, "linear",  "[0, 1]",           "null", \
    "Half way.") \
  F(S, OPTIONAL_VECTOR, sky_low,   "linear",   "[0, 1]",           "null", \
    "At the horizon.") \
  F(S, OPTIONAL_VECTOR, floor,     "linear",   "[0, 1]",           "null", \
    "Colour of the floor's tiles.") \
  F(S, OPTIONAL_VECTOR, grout,     "linear",   "[0, 1]",           "null", \
    "Colour of the lines between them.")

#define SCENE_HEIGHTFIELD(F, O, L, V, S) \
  F(S, NUMBER,    smoothing,       "spacings", "[0, 8]",           "1", \
    "Standard deviation of the filter of the heights; 0: none.") \
  F(S, SWITCH,    drops,           "",         "",                 "true", \
    "Particles that fly above the surface are drawn as balls.") \
  F(S, SWITCH,    second_layer,    "",         "",                 "false", \
    "Water that hangs over air is a layer of its own; off: it is filled down to the floor.") \
  F(S, SWITCH,    mapped,          "",         "",                 "true", \
    "What stands in the water is seen through maps of it; off: rays meet its geometry.") \
  F(S, CHOICE,    eyes,            "",         "each | scaled | one", "\"each\"", \
    "Virtual eyes of these maps: each, one for every ray; scaled, one an object (Eqs. 2, 3), scaled (Fig. 3); one, unscaled.") \
  F(S, CHOICE,    access,          "",         "point | direction", "\"point\"", \
    "How rays look them up: by the point where they pass the object, or by direction alone, as in the paper.") \
  F(S, NUMBER,    plane_reach,     "spacings", "[1, 1000]",        "12", \
    "The plane of an object is that of the surface as far around it.") \
  F(S, NUMBER,    pull_reach,      "spacings", "[0, 1000]",        "6", \
    "Within this of an object the surface is pulled to its plane, so that its parts above and below meet.") \
  F(S, NUMBER,    group_distance,  "spacings", "[0, 1000]",        "1", \
    "Objects that are closer share a plane and an eye.") \
  F(S, SWITCH,    trapezium,       "",         "",                 "true", \
    "The map of objects counts only between an object and the eye (Fig. 8).") \
  F(S, NUMBER,    trapezium_a,     "",         "[0.1, 100]",       "3", \
    "a of Fig. 8: width of the trapezium behind the object, in the object's.") \
  F(S, NUMBER,    trapezium_b,     "",         "[0.1, 100]",       "3", \
    "b of Fig. 8: its width at the eye, in the object's.") \
  F(S, SWITCH,    traced_caustics, "",         "",                 "true", \
    "Sunlight that the surface has bent brightens floor, walls and objects (section 2.4).") \
  F(S, SWITCH,    simple_caustics, "",         "",                 "false", \
    "Patterns of light by Eq. 4; both may be on.") \
  F(S, NUMBER,    simple_height,   "",         "[-100, 100]",      "0.6", \
    "a of Eq. 4: light of the highest water; the lowest has none of it.") \
  F(S, NUMBER,    simple_slope,    "",         "[-100, 100]",      "2", \
    "b of Eq. 4: light of slopes.") \
  F(S, NUMBER,    simple_base,     "",         "[-100, 100]",      "0.6", \
    "c of Eq. 4: light everywhere.") \
  F(S, NUMBER,    dispersion,      "",         "[0, 0.5]",         "0", \
    "Refractive index of blue light less that of red; water has 0.013.")

#define SCENE_POINTS(F, O, L, V, S) \
  F(S, NUMBER,    scale,           "radii",    "[0.1, 5]",         "1.25", \
    "Radius of the spheres drawn, in particle radii.")

#define SCENE_EVENT(F, O, L, V, S) \
  F(S, CHOICE,    type,            "",         "push | pour | tilt | style | camera | drag | emitter", SCENE_REQUIRED, \
    "What happens.") \
  F(S, REAL,      time,            "s",        "[0, 3600]",        "0", \
    "When it begins.") \
  F(S, REAL,      duration,        "s",        "[0, 3600]",        "0", \
    "How long it lasts; 0: one frame.") \
  V(S, PUSH,      push,            ScenePush,       "Accelerates the water around a ray while it lasts.") \
  V(S, POUR,      pour,            ScenePour,       "Fills a box with water, again and again while it lasts.") \
  V(S, TILT,      tilt,            SceneTilt,       "Turns gravity, evenly over the duration.") \
  V(S, STYLE,     style,           SceneStyleEvent, "Changes the style.") \
  V(S, CAMERA,    camera,          SceneCameraEvent, "Moves the camera, smoothly over the duration.") \
  V(S, DRAG,      drag,            SceneDrag,       "Drags a draggable obstacle, evenly over the duration.") \
  V(S, EMITTER,   emitter,         SceneEmitterEvent, "Turns an emitter on or off.")

#define SCENE_PUSH(F, O, L, V, S) \
  F(S, VECTOR,    origin,          "m",        "[-10000, 10000]",  SCENE_REQUIRED, \
    "A point on the ray.") \
  F(S, DIRECTION, direction,       "",         "[-10000, 10000]",  SCENE_REQUIRED, \
    "Along the ray; made a unit vector when read.") \
  F(S, NUMBER,    radius,          "m",        "(0, 1000]",        "0.2", \
    "Distance from the ray at which the push has faded to nothing.") \
  F(S, VECTOR,    acceleration,    "m/s²",     "[-10000, 10000]",  SCENE_REQUIRED, \
    "On the ray itself.")

#define SCENE_POUR(F, O, L, V, S) \
  F(S, VECTOR,    min,             "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Lowest corner.") \
  F(S, VECTOR,    max,             "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Highest corner.") \
  F(S, VECTOR,    velocity,        "m/s",      "[-1000, 1000]",    "[0, 0, 0]", \
    "Velocity of the new water.") \
  F(S, VECTOR,    colour,          "linear",   "[0, 1]",           "[0, 0, 0]", \
    "Colour of the new water; all 0: the natural one.")

#define SCENE_TILT(F, O, L, V, S) \
  F(S, VECTOR,    gravity,         "m/s²",     "[-1000, 1000]",    SCENE_REQUIRED, \
    "Gravity at the end.")

#define SCENE_STYLE_EVENT(F, O, L, V, S) \
  F(S, STYLE,     name,            "",         "",                 SCENE_REQUIRED, \
    "The new style.")

#define SCENE_CAMERA_EVENT(F, O, L, V, S) \
  F(S, VECTOR,    eye,             "m",        "[-10000, 10000]",  SCENE_REQUIRED, \
    "Position of the eye at the end.") \
  F(S, VECTOR,    target,          "m",        "[-10000, 10000]",  SCENE_REQUIRED, \
    "The point looked at, at the end.") \
  F(S, OPTIONAL,  fov,             "degrees",  "(1, 170)",         "null", \
    "Vertical angle of view at the end; null: that of the scene's camera.")

#define SCENE_DRAG(F, O, L, V, S) \
  F(S, REFERENCE, obstacle,        "",         "obstacles",        SCENE_REQUIRED, \
    "The draggable obstacle.") \
  F(S, VECTOR,    position,        "m",        "[-1000, 1000]",    SCENE_REQUIRED, \
    "Where its centre is wanted at the end.") \
  F(S, OPTIONAL_VECTOR, rotation,  "degrees",  "[-360, 360]",      "null", \
    "How it is turned at the end; null: as it was.")

#define SCENE_EMITTER_EVENT(F, O, L, V, S) \
  F(S, REFERENCE, emitter,         "",         "fluid",            SCENE_REQUIRED, \
    "The emitter; its place is that in the list of fluid.") \
  F(S, SWITCH,    on,              "",         "",                 SCENE_REQUIRED, \
    "Whether it runs from now on.")

/// Every struct but the top one, inner ones first: T(Struct, its table).
#define SCENE_STRUCTS(T) \
  T(SceneSimulation, SCENE_SIMULATION) \
  T(SceneContainer, SCENE_CONTAINER) \
  T(SceneBlock, SCENE_BLOCK) \
  T(SceneDrop, SCENE_DROP) \
  T(SceneEmitter, SCENE_EMITTER) \
  T(SceneWave, SCENE_WAVE) \
  T(SceneRipple, SCENE_RIPPLE) \
  T(SceneFluid, SCENE_FLUID) \
  T(SceneSink, SCENE_SINK) \
  T(SceneBox, SCENE_BOX) \
  T(SceneSphere, SCENE_SPHERE) \
  T(SceneCylinder, SCENE_CYLINDER) \
  T(SceneCapsule, SCENE_CAPSULE) \
  T(SceneStairs, SCENE_STAIRS) \
  T(SceneMesh, SCENE_MESH) \
  T(SceneKey, SCENE_KEY) \
  T(SceneObstacle, SCENE_OBSTACLE) \
  T(SceneCamera, SCENE_CAMERA) \
  T(SceneLight, SCENE_LIGHT) \
  T(SceneEnvironment, SCENE_ENVIRONMENT) \
  T(SceneRefraction, SCENE_REFRACTION) \
  T(ScenePoints, SCENE_POINTS) \
  T(SceneRaycast, SCENE_RAYCAST) \
  T(SceneCartoon, SCENE_CARTOON) \
  T(SceneHeightfield, SCENE_HEIGHTFIELD) \
  T(SceneRender, SCENE_RENDER) \
  T(ScenePush, SCENE_PUSH) \
  T(ScenePour, SCENE_POUR) \
  T(SceneTilt, SCENE_TILT) \
  T(SceneStyleEvent, SCENE_STYLE_EVENT) \
  T(SceneCameraEvent, SCENE_CAMERA_EVENT) \
  T(SceneDrag, SCENE_DRAG) \
  T(SceneEmitterEvent, SCENE_EMITTER_EVENT) \
  T(SceneEvent, SCENE_EVENT)
// clang-format on

#endif
