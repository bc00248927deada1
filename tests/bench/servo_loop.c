/* The servo cycle of two axes as an engineer would write it in C, to have something to compare the kernel with.
 *
 * It does what the kernel does for axes in closed loop with the default drive: drive and motor over a sample, commanded
 * position from a table of cubic segments at trajectory updates, encoder, position error check, control law, limits,
 * output converter; at system updates actual velocity, end-of-travel and soft limits, settling, wires, status words.
 * The bench checks that both end in the same state, bit for bit, before it compares their times.
 */

#include <math.h>
#include <stdint.h>

struct segment { double start_s, position, velocity, acceleration, jerk; };

struct axis {
    /* settings */
    double proportional_v, integral_v, velocity_v, velocity_feedforward_v, acceleration_feedforward_v;
    double integral_limit_v, offset_v, output_limit_v;
    double counts_per_rev, encoder_phase, target_distance, target_velocity;
    double speed_per_volt, period_s, lag_decay, loop_decay, lag_to_speed, loop_to_position, lag_to_position;
    double speed_step_limit;
    int64_t encoder_sign, output_sign, position_error_limit, offset_counts;
    int64_t hard_limit_enable, positive_limit_mask, negative_limit_mask, positive_active_level, negative_active_level;
    int64_t soft_limit_enable, positive_soft_limit, negative_soft_limit, watch_mask;
    /* state */
    int64_t enabled, profile_active, profile_start_ns, profile_origin_counts;
    int64_t first_segment, segment_index, segment_count;
    double profile_end_s, profile_end_counts;
    int64_t commanded_counts, encoder_reading, encoder_counts, feedback_counts, previous_feedback_counts;
    int64_t system_feedback_counts, latched_status, status, events, settling;
    double commanded_velocity, commanded_acceleration, actual_velocity;
    double term_p, term_i, term_v, term_vf, term_af, control_v, dac_v, previous_dac_v;
    double true_position, true_velocity, lagged_command;
};

struct unit {
    double servo_s, servo_hz, system_hz, dac_step_v, dac_steps_per_volt, dac_lowest_code, dac_highest_code;
    int64_t next_sample_ns, servo_ns, samples_per_trajectory, trajectories_per_system;
    int64_t samples_to_trajectory, trajectories_to_system, wires, reported_wires, inputs, reported_inputs;
};

enum { MOVE_ENDED = 1, HARD_LIMIT = 2, SOFT_LIMIT = 4, POSITION_ERROR = 8, SETTLED = 16, WIRES = 256 };

static double clamp(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

static void step_drive(struct axis *a)
{
    double command = a->dac_v * a->speed_per_volt;
    double lag_deviation = a->lagged_command - command;
    double speed = a->true_velocity, deviation = speed - command, travel;
    a->lagged_command = command + lag_deviation * a->lag_decay;
    double step = command + deviation * a->loop_decay + lag_deviation * a->lag_to_speed - speed;
    if (fabs(step) <= a->speed_step_limit) {
        travel = command * a->period_s + deviation * a->loop_to_position + lag_deviation * a->lag_to_position;
    } else {
        step = step > 0.0 ? a->speed_step_limit : -a->speed_step_limit;
        travel = (speed + 0.5 * step) * a->period_s;
    }
    a->true_position += travel;
    a->true_velocity = speed + step;
}

static void hold(struct axis *a)
{
    a->profile_active = 0;
    a->commanded_velocity = a->commanded_acceleration = 0.0;
}

static void follow_profile(struct axis *a, const struct segment *segments, int64_t now_ns)
{
    double elapsed_s = (double)(now_ns - a->profile_start_ns) * 1e-9;
    if (elapsed_s >= a->profile_end_s) {
        a->commanded_counts = a->profile_origin_counts + (int64_t)floor(a->profile_end_counts + 0.5);
        hold(a);
        a->events |= MOVE_ENDED;
        return;
    }
    int64_t index = a->segment_index;
    while (index + 1 < a->segment_count && elapsed_s >= segments[index + 1].start_s)
        index++;
    a->segment_index = index;
    const struct segment *s = &segments[index];
    double t = elapsed_s - s->start_s, half_rate = 0.5 * s->jerk * t;
    double position = s->position + t * (s->velocity + t * (0.5 * s->acceleration + half_rate / 3.0));
    a->commanded_counts = a->profile_origin_counts + (int64_t)floor(position + 0.5);
    a->commanded_velocity = s->velocity + t * (s->acceleration + half_rate);
    a->commanded_acceleration = s->acceleration + s->jerk * t;
}

static void read_encoder(struct axis *a)
{
    int64_t reading = (int64_t)floor(a->true_position * a->counts_per_rev + a->encoder_phase);
    a->previous_feedback_counts = a->feedback_counts;
    a->encoder_counts += a->encoder_sign * (reading - a->encoder_reading);
    a->encoder_reading = reading;
    a->feedback_counts = a->encoder_counts;
}

static double control_law(struct axis *a, const struct unit *u)
{
    double error = (double)(a->commanded_counts - a->feedback_counts);
    double velocity = (double)(a->feedback_counts - a->previous_feedback_counts) * u->servo_hz;
    a->term_p = a->proportional_v * error;
    a->term_i = a->integral_v == 0.0
        ? 0.0 : clamp(a->term_i + a->integral_v * error * u->servo_s, a->integral_limit_v);
    a->term_v = -(a->velocity_v * velocity);
    a->term_vf = a->velocity_feedforward_v * a->commanded_velocity;
    a->term_af = a->acceleration_feedforward_v * a->commanded_acceleration;
    return a->term_p + a->term_i + a->term_v + a->term_vf + a->term_af + a->offset_v;
}

static void servo(struct axis *a, const struct unit *u)
{
    int64_t error = a->commanded_counts - a->feedback_counts;
    if (a->position_error_limit > 0 && (error > a->position_error_limit || -error > a->position_error_limit)) {
        a->enabled = 0;
        a->events |= POSITION_ERROR;
        hold(a);
    }
    double volts = 0.0;
    if (a->enabled)
        volts = control_law(a, u);
    else
        a->commanded_counts = a->feedback_counts;
    volts = clamp(clamp(volts, 10.0), a->output_limit_v);
    a->control_v = volts;
    double code = floor((double)a->output_sign * volts * u->dac_steps_per_volt + 0.5);
    code = code > u->dac_highest_code ? u->dac_highest_code : code < u->dac_lowest_code ? u->dac_lowest_code : code;
    a->previous_dac_v = a->dac_v;
    a->dac_v = code * u->dac_step_v;
}

static int64_t limits(const struct axis *a, const struct unit *u)
{
    double velocity = a->commanded_velocity;
    int64_t bits = 0, commanded = a->commanded_counts - a->offset_counts;
    if (velocity > 0.0 && (a->hard_limit_enable & 2) && !!(u->wires & a->positive_limit_mask) == a->positive_active_level)
        bits |= 1 << 14;
    if (velocity < 0.0 && (a->hard_limit_enable & 1) && !!(u->wires & a->negative_limit_mask) == a->negative_active_level)
        bits |= 1 << 15;
    if (a->positive_soft_limit != a->negative_soft_limit) {
        if (velocity > 0.0 && (a->soft_limit_enable & 2) && commanded > a->positive_soft_limit)
            bits |= 1 << 16;
        if (velocity < 0.0 && (a->soft_limit_enable & 1) && commanded < a->negative_soft_limit)
            bits |= 1 << 17;
    }
    return bits;
}

static int in_zone(const struct axis *a)
{
    return !a->profile_active && fabs((double)(a->commanded_counts - a->feedback_counts)) <= a->target_distance
        && fabs(a->actual_velocity) <= a->target_velocity;
}

static int64_t status_word(const struct axis *a)
{
    int64_t bits = a->latched_status;
    if (a->profile_active) {
        double v = a->commanded_velocity, acceleration = a->commanded_acceleration;
        bits |= 1;
        if (v < 0.0 || (v == 0.0 && acceleration < 0.0))
            bits |= 2;
        if (acceleration == 0.0)
            bits |= v != 0.0 ? 8 : 0;
        else if (acceleration * v > 0.0 || v == 0.0)
            bits |= 4;
    }
    bits |= a->enabled ? 0 : 1 << 12;
    return bits | (in_zone(a) ? 1 << 23 : 0);
}

static int64_t system_update(struct unit *u, struct axis *axes, int64_t count)
{
    int64_t fired = 0;
    for (int64_t i = 0; i < count; i++) {
        struct axis *a = &axes[i];
        a->actual_velocity = (double)(a->feedback_counts - a->system_feedback_counts) * u->system_hz;
        a->system_feedback_counts = a->feedback_counts;
        if (a->profile_active) {
            int64_t bits = limits(a, u), fresh = bits & ~a->latched_status;
            a->events |= (fresh & 3 << 14 ? HARD_LIMIT : 0) | (fresh & 3 << 16 ? SOFT_LIMIT : 0);
            a->latched_status |= bits;
        }
        if (a->settling && in_zone(a)) {
            a->settling = 0;
            a->events |= SETTLED;
        }
    }
    if (u->wires != u->reported_wires || u->inputs != u->reported_inputs) {
        u->reported_wires = u->wires;
        u->reported_inputs = u->inputs;
        fired = WIRES;
    }
    for (int64_t i = 0; i < count; i++) {
        fired |= axes[i].events;
        axes[i].events = 0;
    }
    return fired;
}

int64_t advance(struct unit *u, struct axis *axes, const struct segment *segments, int64_t count, int64_t until_ns)
{
    int64_t fired = 0;
    while (!fired && u->next_sample_ns <= until_ns) {
        int64_t now_ns = u->next_sample_ns;
        int trajectory_due = --u->samples_to_trajectory == 0;
        if (trajectory_due)
            u->samples_to_trajectory = u->samples_per_trajectory;
        for (int64_t i = 0; i < count; i++) {
            struct axis *a = &axes[i];
            step_drive(a);
            if (trajectory_due && a->profile_active)
                follow_profile(a, segments + a->first_segment, now_ns);
            read_encoder(a);
            servo(a, u);
        }
        u->next_sample_ns = now_ns + u->servo_ns;
        if (trajectory_due && --u->trajectories_to_system == 0) {
            u->trajectories_to_system = u->trajectories_per_system;
            fired = system_update(u, axes, count);
        }
    }
    for (int64_t i = 0; i < count; i++)
        axes[i].status = status_word(&axes[i]);
    return fired;
}
