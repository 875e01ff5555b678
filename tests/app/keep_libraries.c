// Loaded before the program under AddressSanitizer: libraries stay where they are. OpenGL drivers that were unloaded
// before leaks are looked for leave memory that nothing points to any more and that no suppression can name.
int dlclose(void *library);

int dlclose(void *library) {
  (void)library;
  return 0;
}
