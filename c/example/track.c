/* Tracks the camera through images given by name and prints a pose for each, as a line of a TUM file.
 *
 *   cc -o track track.c $(pkg-config --cflags --libs ldso)
 *   ./track camera.txt 30 image1.pgm image2.pgm ... >trajectory.txt
 *
 * Images are binary PGM files of 8 bit (P5); 30: images a second. What else there is to say goes to standard error, and
 * the map to map.ply. */
#include <ldso.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
  int width, height;
  unsigned char* pixels;
} image;

/* 1 if the file is an image. */
static int read_pgm(const char* path, image* into) {
  FILE* file = fopen(path, "rb");
  int largest = 0, ok = 0;
  if (file == NULL) return 0;
  if (fscanf(file, "P5 %d %d %d", &into->width, &into->height, &largest) == 3 && largest == 255 && into->width > 0 &&
      into->height > 0 && into->width <= 8192 && into->height <= 8192 && fgetc(file) != EOF) {
    const size_t size = (size_t)into->width * (size_t)into->height;
    into->pixels = malloc(size);
    ok = into->pixels != NULL && fread(into->pixels, 1, size, file) == size;
    if (!ok) free(into->pixels);
  }
  fclose(file);
  return ok;
}

static void hear(void* user, int is_warning, const char* text) {
  (void)user;
  fprintf(stderr, "%s%s\n", is_warning ? "warning: " : "", text);
}

static int track(ldso_slam* slam, const char* path, double timestamp) {
  image grey;
  ldso_status status;
  if (!read_pgm(path, &grey)) {
    fprintf(stderr, "error: %s: is no 8-bit PGM image\n", path);
    return 0;
  }
  status = ldso_slam_process_u8(slam, grey.pixels, grey.width, grey.height, grey.width, timestamp, 0, NULL);
  free(grey.pixels);
  if (status != LDSO_OK) fprintf(stderr, "error: %s: %s\n", path, ldso_last_error());
  return status == LDSO_OK;
}

static int finish(ldso_slam* slam) {
  ldso_result* result = ldso_slam_finish(slam);
  size_t count, i;
  ldso_pose* poses;
  int ok;
  if (result == NULL) {
    fprintf(stderr, "error: %s\n", ldso_last_error());
    return 0;
  }
  count = ldso_result_poses(result, NULL, 0);
  poses = malloc((count + 1) * sizeof *poses);
  ok = poses != NULL;
  if (ok) ldso_result_poses(result, poses, count);
  for (i = 0; ok && i < count; ++i) {
    const ldso_pose* p = &poses[i];
    printf("%.9f %.12g %.12g %.12g %.12g %.12g %.12g %.12g\n", p->timestamp, p->tx, p->ty, p->tz, p->qx, p->qy, p->qz,
           p->qw);
  }
  free(poses);
  ok = ok && ldso_result_write_ply(result, "map.ply") == LDSO_OK;
  ldso_result_free(result);
  return ok;
}

int main(int argc, char** argv) {
  ldso_calibration* calibration;
  ldso_slam* slam;
  int i, ok = 1;
  if (argc < 4) {
    fprintf(stderr, "track CAMERA.TXT FPS IMAGE.PGM...\n");
    return 2;
  }
  calibration = ldso_calibration_read(argv[1], 1);
  slam = calibration != NULL ? ldso_slam_new(calibration, NULL, hear, NULL) : NULL;
  ldso_calibration_free(calibration);
  if (slam == NULL) {
    fprintf(stderr, "error: %s\n", ldso_last_error());
    return 1;
  }
  for (i = 3; ok && i < argc; ++i) ok = track(slam, argv[i], (i - 3) / atof(argv[2]));
  ok = finish(slam) && ok;
  ldso_slam_free(slam);
  return ok ? 0 : 1;
}
