/* ldso in C: images in, camera poses and a sparse map out.
 *
 *   ldso_calibration* camera = ldso_calibration_read("camera.txt", 1);
 *   ldso_slam* slam = ldso_slam_new(camera, NULL, NULL, NULL);
 *   while (...) ldso_slam_process_u8(slam, pixels, 640, 480, 640, timestamp, 0, &frame);
 *   ldso_result* result = ldso_slam_finish(slam);
 *   ldso_result_write_tum(result, "trajectory.txt");
 *
 * A function that can fail returns NULL or LDSO_ERROR, and ldso_last_error() says why: where, what, and what to do
 * about it. No exception leaves a function. What a function returns a pointer to is the caller's, to be given to the
 * matching _free(), which takes NULL as well. An object must not be used by two threads at once; several objects may.
 *
 * What is declared here stays as it is in all versions of libldso.so.1: functions and structs may be added, none
 * changed. */
#ifndef LDSO_H
#define LDSO_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define LDSO_API __attribute__((visibility("default")))
#else
#define LDSO_API
#endif

typedef enum ldso_status { LDSO_OK = 0, LDSO_ERROR = 1 } ldso_status;
typedef enum ldso_state { LDSO_INITIALIZING = 0, LDSO_TRACKED = 1, LDSO_LOST = 2 } ldso_state;

typedef struct ldso_calibration ldso_calibration;
typedef struct ldso_settings ldso_settings;
typedef struct ldso_slam ldso_slam;
typedef struct ldso_result ldso_result;

/* What is said of a frame. */
typedef struct ldso_frame {
  int64_t frame_id;    /* Counts the calls, from 0. */
  int64_t keyframe_id; /* frame_id of its reference keyframe, or -1. */
  ldso_state state;
  int32_t is_keyframe; /* 0 or 1 */
  float residual_rmse; /* [grey levels] */
  int32_t reserved;    /* 0 */
} ldso_frame;

/* Camera to world, as a line of a TUM file. */
typedef struct ldso_pose {
  int64_t frame_id;
  double timestamp;  /* [s] */
  double tx, ty, tz; /* [map units] */
  double qx, qy, qz, qw;
} ldso_pose;

typedef struct ldso_point {
  double x, y, z;      /* In the world [map units]. */
  float intensity;     /* 0..255 */
  float idepth_stddev; /* Of the inverse depth in the host keyframe [1 / map unit]. */
  int64_t keyframe_id; /* The host. */
} ldso_point;

/* Hears of losses and restarts, and of a calibration that the images contradict; may be called on other threads. */
typedef void (*ldso_log)(void* user, int is_warning, const char* text);

/* "0.2.0" */
LDSO_API const char* ldso_version(void);
/* Why the last function that failed on this thread did so. Stays until the next one fails. */
LDSO_API const char* ldso_last_error(void);

/* camera.txt, or a calibration as another program wrote it; with photometric != 0 also pcalib.txt and vignette.png
 * beside it, where they exist. */
LDSO_API ldso_calibration* ldso_calibration_read(const char* path, int photometric);
/* Without distortion; in pixels, whose centres are at integers. */
LDSO_API ldso_calibration* ldso_calibration_pinhole(int width, int height, double fx, double fy, double cx, double cy);
/* As camera.txt. */
LDSO_API ldso_status ldso_calibration_write(const ldso_calibration* calibration, const char* path);
LDSO_API void ldso_calibration_free(ldso_calibration* calibration);

/* The defaults. */
LDSO_API ldso_settings* ldso_settings_new(void);
/* By name, as on the command line: "window.iterations", "8". */
LDSO_API ldso_status ldso_settings_set(ldso_settings* settings, const char* key, const char* value);
/* Those that a YAML file names. */
LDSO_API ldso_status ldso_settings_read(ldso_settings* settings, const char* path);
LDSO_API void ldso_settings_free(ldso_settings* settings);

/* settings may be NULL: the defaults. log may be NULL; user is passed to it. Both are copied from. */
LDSO_API ldso_slam* ldso_slam_new(const ldso_calibration* calibration, const ldso_settings* settings, ldso_log log,
                                  void* user);
/* One grey image as the camera took it, of the calibration's size; stride: pixels from a row to the next. 16 bit: full
 * range; float: grey levels in 0..255. timestamp in seconds; exposure_ms is unknown unless it is positive. frame may be
 * NULL. A frame that is refused leaves everything as it was. */
LDSO_API ldso_status ldso_slam_process_u8(ldso_slam* slam, const uint8_t* pixels, int width, int height,
                                          ptrdiff_t stride, double timestamp, double exposure_ms, ldso_frame* frame);
LDSO_API ldso_status ldso_slam_process_u16(ldso_slam* slam, const uint16_t* pixels, int width, int height,
                                           ptrdiff_t stride, double timestamp, double exposure_ms, ldso_frame* frame);
LDSO_API ldso_status ldso_slam_process_f32(ldso_slam* slam, const float* pixels, int width, int height,
                                           ptrdiff_t stride, double timestamp, double exposure_ms, ldso_frame* frame);
/* Why the newest frame has no pose; empty if it has one. Stays until the next frame. */
LDSO_API const char* ldso_slam_reason(const ldso_slam* slam);
/* The newest frame's pose as now estimated. 1; 0 if it is not tracked, and pose is as it was. */
LDSO_API int ldso_slam_pose(const ldso_slam* slam, ldso_pose* pose);
/* The result so far; the run goes on. */
LDSO_API ldso_result* ldso_slam_snapshot(const ldso_slam* slam);
/* Ends the run. No frame can follow. */
LDSO_API ldso_result* ldso_slam_finish(ldso_slam* slam);
LDSO_API void ldso_slam_free(ldso_slam* slam);

/* Poses of all frames that have one, and the points of the map, after loop closing. At most `most` are written to where
 * poses (points) points; returns how many there are. */
LDSO_API size_t ldso_result_poses(const ldso_result* result, ldso_pose* poses, size_t most);
LDSO_API size_t ldso_result_points(const ldso_result* result, ldso_point* points, size_t most);
/* How often the map was lost and a new one begun. */
LDSO_API int ldso_result_restarts(const ldso_result* result);
/* A calibration that explains the images better, if they contradict the given one; else NULL, which is no error. */
LDSO_API ldso_calibration* ldso_result_better_calibration(const ldso_result* result);
LDSO_API ldso_status ldso_result_write_tum(const ldso_result* result, const char* path);
LDSO_API ldso_status ldso_result_write_ply(const ldso_result* result, const char* path);
LDSO_API void ldso_result_free(ldso_result* result);

#ifdef __cplusplus
}
#endif

#endif /* LDSO_H */
