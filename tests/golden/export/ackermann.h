/* Robot 'courier' of class ackermann, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_B (0.604500) /* nominal 0.600000, +- 1.3e-05 m */
#define ODOMETRY_WHEELBASE (1.015000) /* nominal 1.000000, +- 1.3e-05 m */
#define ODOMETRY_B_FRONT (0.613500) /* nominal 0.600000, +- 1.3e-05 m */
#define ODOMETRY_R_RIGHT (0.103000) /* nominal 0.100000, +- 1.3e-05 m */
#define ODOMETRY_R_LEFT (0.103750) /* nominal 0.100000, +- 1.3e-05 m */
#define ODOMETRY_ZERO_RIGHT (0.030000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_ZERO_LEFT (0.035000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_WHEEL_RIGHT_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_RIGHT_Y (-0.302250) /* m, nominal -0.300000 */
#define ODOMETRY_WHEEL_RIGHT_RADIUS (0.103000) /* m, nominal 0.100000 */
#define ODOMETRY_WHEEL_LEFT_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_LEFT_Y (0.302250) /* m, nominal 0.300000 */
#define ODOMETRY_WHEEL_LEFT_RADIUS (0.103750) /* m, nominal 0.100000 */
#define ODOMETRY_STEERING_RIGHT_X (1.015000) /* m, nominal 1.000000 */
#define ODOMETRY_STEERING_RIGHT_Y (-0.306750) /* m, nominal -0.300000 */
#define ODOMETRY_STEERING_RIGHT_STEERING_OFFSET (0.030000) /* rad, nominal 0.000000 */
#define ODOMETRY_STEERING_LEFT_X (1.015000) /* m, nominal 1.000000 */
#define ODOMETRY_STEERING_LEFT_Y (0.306750) /* m, nominal 0.300000 */
#define ODOMETRY_STEERING_LEFT_STEERING_OFFSET (0.035000) /* rad, nominal 0.000000 */

#endif
