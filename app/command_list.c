// lido list: what this copy of the program has and what works on this machine.
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/context.h"
#include "app/scene.h"

enum { MAX_SCENES = 256, NAME_SIZE = 128 };

static bool is_scene_file(const char *name) {
  static const char ending[] = ".json", schema[] = "scene.schema.json";
  size_t length = strlen(name);
  return length > strlen(ending) && length < NAME_SIZE && !strcmp(name + length - strlen(ending), ending) &&
         strcmp(name, schema) != 0;
}

static int compare_names(const void *a, const void *b) {
  return strcmp(a, b);
}

static void list_scenes(void) {
  char folder[1024], path[1024 + NAME_SIZE];
  printf("scenes (lido NAME)\n");
  DIR *directory = scene_folder(folder, sizeof folder) ? opendir(folder) : NULL;
  if (!directory) {
    printf("  none found beside the program\n");
    return;
  }
  char names[MAX_SCENES][NAME_SIZE];
  int count = 0;
  for (struct dirent *entry; count < MAX_SCENES && (entry = readdir(directory));)
    if (is_scene_file(entry->d_name)) snprintf(names[count++], NAME_SIZE, "%.*s", NAME_SIZE - 1, entry->d_name);
  closedir(directory);
  qsort(names, (size_t)count, NAME_SIZE, compare_names);

  for (int i = 0; i < count; i++) {
    Scene scene;
    AppError error;
    snprintf(path, sizeof path, "%s/%s", folder, names[i]);
    names[i][strlen(names[i]) - strlen(".json")] = 0;
    if (scene_load(&scene, path, NULL, 0, &error)) {
      printf("  %-18s %s (%lld particles)\n", names[i], scene.name, (long long)scene_particle_count(&scene));
      scene_free(&scene);
    } else {
      printf("  %-18s unusable: %s\n", names[i], error.message);
    }
  }
}

static void list_styles(void) {
  printf("\nstyles (--style NAME)\n");
  for (int i = 0; i < render_style_count(); i++) {
    const char *style = render_style_name(i);
    printf("  %-18s %s\n  %-18s layers (--layer NAME):", style, render_style_summary(i), "");
    for (int layer = 0; layer < render_layer_count(style); layer++) printf(" %s", render_layer_name(style, layer));
    printf("\n");
  }
}

static void list_contexts(void) {
  printf("\ncontexts (--context NAME)\n");
  for (int i = 0; i < context_backend_count(); i++) {
    const ContextBackend *backend = context_backend(i);
    char why[256];
    bool works = backend->available(why, sizeof why);
    printf("  %-18s %s: %s%s\n", backend->name, backend->summary, works ? "works here" : "not here, ",
           works ? "" : why);
  }
}

bool command_list(const Options *options, AppError *error) {
  (void)options;
  list_scenes();
  list_styles();
  list_contexts();
  if (fflush(stdout) || ferror(stdout)) return app_fail(error, APP_FAILED, "cannot write to standard output");
  return true;
}
