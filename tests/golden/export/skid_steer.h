/* Robot 'courier' of class skid_steer, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_SLIP (1.575000000) /* nominal 1.500000000, +- 1.3e-05 */
#define ODOMETRY_R_RIGHT (0.101500) /* nominal 0.100000, +- 1.3e-05 m */
#define ODOMETRY_R_LEFT (0.102250) /* nominal 0.100000, +- 1.3e-05 m */
#define ODOMETRY_WHEEL_RIGHT_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_RIGHT_Y (-0.393750) /* m, nominal -0.375000 */
#define ODOMETRY_WHEEL_RIGHT_RADIUS (0.101500) /* m, nominal 0.100000 */
#define ODOMETRY_WHEEL_LEFT_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_LEFT_Y (0.393750) /* m, nominal 0.375000 */
#define ODOMETRY_WHEEL_LEFT_RADIUS (0.102250) /* m, nominal 0.100000 */

#endif
