// Share of unpolarised light that is mirrored where it meets a surface at this cosine (Fresnel's equations); `index` is that of
// where it goes to, in that of where it comes from.
float fresnel(float cosine, float index) {
  float c = clamp(cosine, 0.0, 1.0), sine2 = (1.0 - c * c) / (index * index), bent = sqrt(max(1.0 - sine2, 0.0));
  float across = (c - index * bent) / (c + index * bent), along = (index * c - bent) / (index * c + bent);
  return sine2 >= 1.0 ? 1.0 : 0.5 * (across * across + along * along);
}
