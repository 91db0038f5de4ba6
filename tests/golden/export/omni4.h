/* Robot 'courier' of class omni4, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_R (0.201500) /* nominal 0.200000, +- 1.3e-05 m */
#define ODOMETRY_R1 (0.050750) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R2 (0.051125) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R3 (0.051500) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R4 (0.051875) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_FRONT_LEFT_X (0.142482) /* m, nominal 0.141421 */
#define ODOMETRY_FRONT_LEFT_Y (0.142482) /* m, nominal 0.141421 */
#define ODOMETRY_FRONT_LEFT_RADIUS (0.050750) /* m, nominal 0.050000 */
#define ODOMETRY_FRONT_LEFT_MOUNT (2.356194) /* rad, nominal 2.356194 */
#define ODOMETRY_REAR_LEFT_X (-0.142482) /* m, nominal -0.141421 */
#define ODOMETRY_REAR_LEFT_Y (0.142482) /* m, nominal 0.141421 */
#define ODOMETRY_REAR_LEFT_RADIUS (0.051125) /* m, nominal 0.050000 */
#define ODOMETRY_REAR_LEFT_MOUNT (3.926991) /* rad, nominal 3.926991 */
#define ODOMETRY_REAR_RIGHT_X (-0.142482) /* m, nominal -0.141421 */
#define ODOMETRY_REAR_RIGHT_Y (-0.142482) /* m, nominal -0.141421 */
#define ODOMETRY_REAR_RIGHT_RADIUS (0.051500) /* m, nominal 0.050000 */
#define ODOMETRY_REAR_RIGHT_MOUNT (5.497787) /* rad, nominal 5.497787 */
#define ODOMETRY_FRONT_RIGHT_X (0.142482) /* m, nominal 0.141421 */
#define ODOMETRY_FRONT_RIGHT_Y (-0.142482) /* m, nominal -0.141421 */
#define ODOMETRY_FRONT_RIGHT_RADIUS (0.051875) /* m, nominal 0.050000 */
#define ODOMETRY_FRONT_RIGHT_MOUNT (7.068583) /* rad, nominal 7.068583 */

#endif
