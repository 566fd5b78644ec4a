/* What must be refused, with a reason, and never crash. */
#include <ldso.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void expect(int is_refused, const char* reason) {
  if (is_refused && strstr(ldso_last_error(), reason) != NULL) return;
  printf("not refused by '%s': %s\n", reason, ldso_last_error());
  ++failures;
}

int main(void) {
  static unsigned char pixels[64 * 48];
  ldso_settings* settings = ldso_settings_new();
  ldso_calibration* camera = ldso_calibration_pinhole(64, 48, 50, 50, 31.5, 23.5);
  ldso_slam* slam;
  ldso_result* result;
  ldso_frame frame;
  ldso_pose pose;

  expect(ldso_calibration_read(NULL, 1) == NULL, "path: it is NULL");
  expect(ldso_settings_set(settings, "thread", "1") == LDSO_ERROR, "threads");
  expect(ldso_settings_set(settings, "threads", "many") == LDSO_ERROR, "threads");
  expect(ldso_slam_new(NULL, NULL, NULL, NULL) == NULL, "calibration: it is NULL");
  slam = ldso_slam_new(camera, settings, NULL, NULL);
  if (slam == NULL) return 1;
  expect(ldso_slam_process_u8(slam, NULL, 64, 48, 64, 0, 0, &frame) == LDSO_ERROR, "no pixels");
  expect(ldso_slam_process_u8(slam, pixels, 32, 48, 64, 0, 0, &frame) == LDSO_ERROR, "32 x 48");
  expect(ldso_slam_process_u8(NULL, pixels, 64, 48, 64, 0, 0, &frame) == LDSO_ERROR, "slam: it is NULL");
  if (ldso_slam_process_u8(slam, pixels, 64, 48, 64, 0, 0, &frame) != LDSO_OK || frame.frame_id != 0 ||
      frame.state != LDSO_INITIALIZING || ldso_slam_reason(slam)[0] == 0 || ldso_slam_pose(slam, &pose) != 0)
    ++failures;
  result = ldso_slam_finish(slam);
  if (ldso_result_poses(result, &pose, 1) != 0 || ldso_result_points(result, NULL, 0) != 0) ++failures;
  if (ldso_result_better_calibration(result) != NULL) ++failures;
  expect(ldso_slam_finish(slam) == NULL, "finished");
  expect(ldso_result_write_tum(result, "/no/such/folder/trajectory.txt") == LDSO_ERROR, "/no/such/folder");
  ldso_result_free(result);
  ldso_slam_free(slam);
  ldso_slam_free(NULL);
  ldso_calibration_free(camera);
  ldso_settings_free(settings);
  return failures;
}
