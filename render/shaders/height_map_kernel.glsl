// What the passes over the height field share: nodes, and the kernel with which they are weighted.
layout(std140, binding = 1) uniform Params {
  ivec4 nodes;          // columns, rows; texels to a spacing; reach of the kernel, spacings
  vec4 kernel;          // -1/2σ² of the Gaussian and of the wider, faint one; reference, m; 1/spacing of texels, 1/m
};
layout(std430, binding = 1) readonly buffer Heights { float heights[]; }; // over the reference, m; DRY: no water

const float DRY = 1e9;

// Beyond the outermost nodes are their mirror images.
int mirrored(int i, int count) {
  int period = max(2 * (count - 1), 1);
  i = abs(i) % period;
  return min(i, period - i) % count;
}

// Weight of a node that is x spacings away.
float weight(float x) {
  float xx = x * x;
  return exp(kernel.x * xx) + 1e-3 * exp(kernel.y * xx);
}

// The nodes around texel i: where it is among them, the first and the last of the kernel.
struct Window {
  float at;
  int first, last;
};

Window window(int i) {
  int node = i / nodes.z;
  return Window(float(i) / float(nodes.z), node - nodes.w, node + nodes.w + 1);
}
