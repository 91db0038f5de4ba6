/* Robot 'courier' of class differential, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_B (0.302250) /* nominal 0.300000, +- 1.3e-05 m */
#define ODOMETRY_R_RIGHT (0.050750) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_R_LEFT (0.051125) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_WHEEL_RIGHT_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_RIGHT_Y (-0.151125) /* m, nominal -0.150000 */
#define ODOMETRY_WHEEL_RIGHT_RADIUS (0.050750) /* m, nominal 0.050000 */
#define ODOMETRY_WHEEL_LEFT_X (0.000000) /* m, nominal 0.000000 */
#define ODOMETRY_WHEEL_LEFT_Y (0.151125) /* m, nominal 0.150000 */
#define ODOMETRY_WHEEL_LEFT_RADIUS (0.051125) /* m, nominal 0.050000 */

#endif
