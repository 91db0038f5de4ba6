/* Robot 'courier' of class mecanum, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_LX (0.201500) /* nominal 0.200000, +- 1.3e-05 m */
#define ODOMETRY_LY (0.203000) /* nominal 0.200000, +- 1.3e-05 m */
#define ODOMETRY_ROLLER (0.798488) /* nominal 0.785398, +- 1.3e-05 rad */
#define ODOMETRY_R1 (0.051500) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R2 (0.051875) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R3 (0.052250) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R4 (0.052625) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_FRONT_LEFT_X (0.201500) /* m, nominal 0.200000 */
#define ODOMETRY_FRONT_LEFT_Y (0.203000) /* m, nominal 0.200000 */
#define ODOMETRY_FRONT_LEFT_RADIUS (0.051500) /* m, nominal 0.050000 */
#define ODOMETRY_FRONT_LEFT_ROLLER (-0.798488) /* rad, nominal -0.785398 */
#define ODOMETRY_FRONT_RIGHT_X (0.201500) /* m, nominal 0.200000 */
#define ODOMETRY_FRONT_RIGHT_Y (-0.203000) /* m, nominal -0.200000 */
#define ODOMETRY_FRONT_RIGHT_RADIUS (0.051875) /* m, nominal 0.050000 */
#define ODOMETRY_FRONT_RIGHT_ROLLER (0.798488) /* rad, nominal 0.785398 */
#define ODOMETRY_REAR_LEFT_X (-0.201500) /* m, nominal -0.200000 */
#define ODOMETRY_REAR_LEFT_Y (0.203000) /* m, nominal 0.200000 */
#define ODOMETRY_REAR_LEFT_RADIUS (0.052250) /* m, nominal 0.050000 */
#define ODOMETRY_REAR_LEFT_ROLLER (0.798488) /* rad, nominal 0.785398 */
#define ODOMETRY_REAR_RIGHT_X (-0.201500) /* m, nominal -0.200000 */
#define ODOMETRY_REAR_RIGHT_Y (-0.203000) /* m, nominal -0.200000 */
#define ODOMETRY_REAR_RIGHT_RADIUS (0.052625) /* m, nominal 0.050000 */
#define ODOMETRY_REAR_RIGHT_ROLLER (-0.798488) /* rad, nominal -0.785398 */

#endif
