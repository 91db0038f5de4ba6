/* Robot 'courier' of class omni3, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_R (0.201500) /* nominal 0.200000, +- 1.3e-05 m */
#define ODOMETRY_R1 (0.050750) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R2 (0.051125) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R3 (0.051500) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_WHEEL_1_X (0.100750) /* m, nominal 0.100000 */
#define ODOMETRY_WHEEL_1_Y (-0.174504) /* m, nominal -0.173205 */
#define ODOMETRY_WHEEL_1_RADIUS (0.050750) /* m, nominal 0.050000 */
#define ODOMETRY_WHEEL_1_MOUNT (-2.617994) /* rad, nominal -2.617994 */
#define ODOMETRY_WHEEL_2_X (0.100750) /* m, nominal 0.100000 */
#define ODOMETRY_WHEEL_2_Y (0.174504) /* m, nominal 0.173205 */
#define ODOMETRY_WHEEL_2_RADIUS (0.051125) /* m, nominal 0.050000 */
#define ODOMETRY_WHEEL_2_MOUNT (-0.523599) /* rad, nominal -0.523599 */
#define ODOMETRY_WHEEL_3_X (-0.201500) /* m, nominal -0.200000 */
#define ODOMETRY_WHEEL_3_Y (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_3_RADIUS (0.051500) /* m, nominal 0.050000 */
#define ODOMETRY_WHEEL_3_MOUNT (1.570796) /* rad, nominal 1.570796 */

#endif
