// What is a crease and what a step in depth. Include it after frame.glsl.
const float GAP = 3.0;        // smallest step in depth that is outlined, in metres that a pixel covers there
const float WIDE_GAP = 30.0;  // a larger one is always a silhouette, however the surfaces are slanted

// The least change, from one side of a crease to the other, of how the inverse depth changes from pixel to pixel: two thirds
// of that of a crease straight across, seen with both sides turned away alike.
float least_bend(float inverse) {
  return 0.66 * sqrt(max(2.0 - 2.0 * drawn_ink.a, 0.0)) * (2.0 * lens.y / lens.w) * inverse;
}
