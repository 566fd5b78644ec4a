/* How the structs of ldso.h lie in memory. */
#include <ldso.h>
#include <stddef.h>
#include <stdio.h>

#define SIZE(type) printf(#type " %lu\n", (unsigned long)sizeof(type))
#define MEMBER(type, member) printf(#type "." #member " %lu\n", (unsigned long)offsetof(type, member))

int main(void) {
  SIZE(ldso_status);
  SIZE(ldso_state);
  SIZE(ldso_frame);
  MEMBER(ldso_frame, frame_id);
  MEMBER(ldso_frame, keyframe_id);
  MEMBER(ldso_frame, state);
  MEMBER(ldso_frame, is_keyframe);
  MEMBER(ldso_frame, residual_rmse);
  MEMBER(ldso_frame, reserved);
  SIZE(ldso_pose);
  MEMBER(ldso_pose, frame_id);
  MEMBER(ldso_pose, timestamp);
  MEMBER(ldso_pose, tx);
  MEMBER(ldso_pose, qx);
  MEMBER(ldso_pose, qw);
  SIZE(ldso_point);
  MEMBER(ldso_point, x);
  MEMBER(ldso_point, intensity);
  MEMBER(ldso_point, idepth_stddev);
  MEMBER(ldso_point, keyframe_id);
  return 0;
}
