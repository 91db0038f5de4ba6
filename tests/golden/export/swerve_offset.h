/* Robot 'courier' of class swerve_offset, calibrated by lm (row 'lm', run 0123456789ab, 2026-01-02T03:04:05Z) */
/* on data set 'drives' (cccccccccccc), calibration[every_sample,arc], J = 0.0125 */
#ifndef ODOMETRY_H
#define ODOMETRY_H

#define ODOMETRY_X1 (0.214382) /* nominal 0.212132, +- 1.3e-05 m */
#define ODOMETRY_Y1 (0.216632) /* nominal 0.212132, +- 1.3e-05 m */
#define ODOMETRY_R1 (0.051125) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_ZERO1 (0.020000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_OFFSET1 (0.006250) /* nominal 0.000000, +- 1.3e-05 m */
#define ODOMETRY_X2 (-0.198632) /* nominal -0.212132, +- 1.3e-05 m */
#define ODOMETRY_Y2 (0.227882) /* nominal 0.212132, +- 1.3e-05 m */
#define ODOMETRY_R2 (0.050375) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_ZERO2 (0.010000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_OFFSET2 (0.003750) /* nominal 0.000000, +- 1.3e-05 m */
#define ODOMETRY_X3 (-0.203132) /* nominal -0.212132, +- 1.3e-05 m */
#define ODOMETRY_Y3 (-0.200882) /* nominal -0.212132, +- 1.3e-05 m */
#define ODOMETRY_R3 (0.052250) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_ZERO3 (0.035000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_OFFSET3 (0.001250) /* nominal 0.000000, +- 1.3e-05 m */
#define ODOMETRY_X4 (0.216632) /* nominal 0.212132, +- 1.3e-05 m */
#define ODOMETRY_Y4 (-0.205382) /* nominal -0.212132, +- 1.3e-05 m */
#define ODOMETRY_R4 (0.051500) /* nominal 0.050000, +- 1.3e-05 m */
#define ODOMETRY_ZERO4 (0.025000) /* nominal 0.000000, +- 1.3e-05 rad */
#define ODOMETRY_OFFSET4 (0.007500) /* nominal 0.000000, +- 1.3e-05 m */
#define ODOMETRY_FRONT_LEFT_X (0.214382) /* m, nominal 0.212132 */
#define ODOMETRY_FRONT_LEFT_Y (0.216632) /* m, nominal 0.212132 */
#define ODOMETRY_FRONT_LEFT_RADIUS (0.051125) /* m, nominal 0.050000 */
#define ODOMETRY_FRONT_LEFT_STEERING_OFFSET (0.020000) /* rad, nominal 0.000000 */
#define ODOMETRY_FRONT_LEFT_CONTACT_LEFT (0.006250) /* m, nominal 0.000000 */
#define ODOMETRY_REAR_LEFT_X (-0.198632) /* m, nominal -0.212132 */
#define ODOMETRY_REAR_LEFT_Y (0.227882) /* m, nominal 0.212132 */
#define ODOMETRY_REAR_LEFT_RADIUS (0.050375) /* m, nominal 0.050000 */
#define ODOMETRY_REAR_LEFT_STEERING_OFFSET (0.010000) /* rad, nominal 0.000000 */
#define ODOMETRY_REAR_LEFT_CONTACT_LEFT (0.003750) /* m, nominal 0.000000 */
#define ODOMETRY_REAR_RIGHT_X (-0.203132) /* m, nominal -0.212132 */
#define ODOMETRY_REAR_RIGHT_Y (-0.200882) /* m, nominal -0.212132 */
#define ODOMETRY_REAR_RIGHT_RADIUS (0.052250) /* m, nominal 0.050000 */
#define ODOMETRY_REAR_RIGHT_STEERING_OFFSET (0.035000) /* rad, nominal 0.000000 */
#define ODOMETRY_REAR_RIGHT_CONTACT_LEFT (0.001250) /* m, nominal 0.000000 */
#define ODOMETRY_FRONT_RIGHT_X (0.216632) /* m, nominal 0.212132 */
#define ODOMETRY_FRONT_RIGHT_Y (-0.205382) /* m, nominal -0.212132 */
#define ODOMETRY_FRONT_RIGHT_RADIUS (0.051500) /* m, nominal 0.050000 */
#define ODOMETRY_FRONT_RIGHT_STEERING_OFFSET (0.025000) /* rad, nominal 0.000000 */
#define ODOMETRY_FRONT_RIGHT_CONTACT_LEFT (0.007500) /* m, nominal 0.000000 */

#endif
