// Solid bodies as shaders know them: struct Body of obstacles.c.
struct Body {
  vec4 position;        // m; –
  vec4 half_size;       // m, of the box around it, along its own axes; stairs: steps; capsule: half its straight part, m;
                        // mesh: x is its reach, m
  vec4 rotation;        // quaternion
  vec4 colour;          // linear; –
};
layout(std430, binding = 0) readonly buffer Bodies { Body bodies[]; };

vec3 rotate(vec4 q, vec3 v) {
  return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}
