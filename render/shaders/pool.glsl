// What the passes of the style "heightfield" know about the water and about what stands in it: struct Pool of object_maps.c.
struct WaterObject {
  vec4 plane;           // the surface around it: unit normal upwards; dot(normal, p) + w is a point's height over it
  vec4 low, high;       // ends of its main axis, m; –, half its width at the plane, m
  vec4 middle;          // of that width, on the plane, m; –
  vec4 eye_refracted;   // Eq. 2
  vec4 a;               // the point of plane and object nearest to the eye
  vec4 seen_b, unscaled_b; // where on the plane the eye sees its lowest point, and that one eye shows it (b'_real, b' of Figure 3)
};

layout(std430, binding = 6) readonly buffer Pool {
  vec4 height_place;    // texture coordinate of (x, z)
  vec4 height_range;    // lowest and highest water, m; metres between texels; –
  vec4 height_slope;    // mean slopes along x and z; –
  vec4 caustic_u, caustic_v; // place in the maps of light and solids
  vec4 caustic_way;     // unit, the refracted sunlight, downwards; –
  vec4 caustic_simple;  // a, b, c of Eq. 4; 1 when it is on
  vec4 caustic_walls;   // middle (x, z) of a round container, radius at which the water is mirrored, m; radius 0: at the field's
                        // border; the refracted sunlight below level water, across it, in that of the sun
  vec4 optics;          // refractive index; border of the maps of objects, pixels; a and b of the trapezium
  ivec4 numbers;        // objects; vertices along x and z of the surface's mesh; texels from one to the next
  vec4 colour_grid;     // x and z of the first colour, between colours, water that has 1 − 1/e of its colour; m
  ivec4 colour_numbers; // along x and z; –
  WaterObject objects[];
};
