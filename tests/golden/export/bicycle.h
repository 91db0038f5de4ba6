/* Robot 'courier' of class bicycle, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_WHEELBASE (1.007500) /* nominal 1.000000, +- 1.3e-05 m */
#define ODOMETRY_R (0.101500) /* nominal 0.100000, +- 1.3e-05 m */
#define ODOMETRY_STEERING_ZERO (0.015000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_GAIN (1.020000000) /* nominal 1.000000000, +- 1.3e-05 */
#define ODOMETRY_WHEEL_1_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_1_Y (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_1_RADIUS (0.101500) /* m, nominal 0.100000 */
#define ODOMETRY_STEERING_X (1.007500) /* m, nominal 1.000000 */
#define ODOMETRY_STEERING_Y (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_STEERING_STEERING_OFFSET (0.015000) /* rad, nominal 0.000000 */
#define ODOMETRY_STEERING_STEERING_GAIN (1.020000) /* ratio, nominal 1.000000 */

#endif
