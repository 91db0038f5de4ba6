/* Robot 'courier' of class 4wis4wid, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_A1 (0.112781) /* nominal 0.112500, +- 1.3e-05 m */
#define ODOMETRY_A2 (-0.111937) /* nominal -0.112500, +- 1.3e-05 m */
#define ODOMETRY_A3 (-0.111656) /* nominal -0.112500, +- 1.3e-05 m */
#define ODOMETRY_A4 (0.113625) /* nominal 0.112500, +- 1.3e-05 m */
#define ODOMETRY_B1 (0.113906) /* nominal 0.112500, +- 1.3e-05 m */
#define ODOMETRY_B2 (0.114188) /* nominal 0.112500, +- 1.3e-05 m */
#define ODOMETRY_B3 (-0.110531) /* nominal -0.112500, +- 1.3e-05 m */
#define ODOMETRY_B4 (-0.112219) /* nominal -0.112500, +- 1.3e-05 m */
#define ODOMETRY_R1 (0.025527) /* nominal 0.025400, +- 1.3e-05 m */
#define ODOMETRY_R2 (0.025590) /* nominal 0.025400, +- 1.3e-05 m */
#define ODOMETRY_R3 (0.025654) /* nominal 0.025400, +- 1.3e-05 m */
#define ODOMETRY_R4 (0.025717) /* nominal 0.025400, +- 1.3e-05 m */
#define ODOMETRY_FRONT_LEFT_X (0.112781) /* m, nominal 0.112500 */
#define ODOMETRY_FRONT_LEFT_Y (0.113906) /* m, nominal 0.112500 */
#define ODOMETRY_FRONT_LEFT_RADIUS (0.025527) /* m, nominal 0.025400 */
#define ODOMETRY_FRONT_LEFT_STEERING_OFFSET (0.000000) /* rad, nominal 0.000000 */
#define ODOMETRY_REAR_LEFT_X (-0.111937) /* m, nominal -0.112500 */
#define ODOMETRY_REAR_LEFT_Y (0.114188) /* m, nominal 0.112500 */
#define ODOMETRY_REAR_LEFT_RADIUS (0.025590) /* m, nominal 0.025400 */
#define ODOMETRY_REAR_LEFT_STEERING_OFFSET (0.000000) /* rad, nominal 0.000000 */
#define ODOMETRY_REAR_RIGHT_X (-0.111656) /* m, nominal -0.112500 */
#define ODOMETRY_REAR_RIGHT_Y (-0.110531) /* m, nominal -0.112500 */
#define ODOMETRY_REAR_RIGHT_RADIUS (0.025654) /* m, nominal 0.025400 */
#define ODOMETRY_REAR_RIGHT_STEERING_OFFSET (0.000000) /* rad, nominal 0.000000 */
#define ODOMETRY_FRONT_RIGHT_X (0.113625) /* m, nominal 0.112500 */
#define ODOMETRY_FRONT_RIGHT_Y (-0.112219) /* m, nominal -0.112500 */
#define ODOMETRY_FRONT_RIGHT_RADIUS (0.025717) /* m, nominal 0.025400 */
#define ODOMETRY_FRONT_RIGHT_STEERING_OFFSET (0.000000) /* rad, nominal 0.000000 */

#endif
