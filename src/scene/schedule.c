// SPDX-License-Identifier: MIT
#include "scene/schedule.h"

#include <math.h>

// Rates and speeds are float32 values, so quotients such as 119.88 / 23.976 are off by 1e-7.
// Numbers this close to an integer are rounded.
static const double WHOLE = 1e-6;

static double nearly_whole(double number)
{
    return fabs(number - round(number)) < WHOLE * number ? round(number) : number;
}

double schedule_frame_time(const RunParams *run, double frame)
{
    return frame * (double)run->speed / (double)run->fps;
}

double schedule_period_rate(const RunParams *run)
{
    if (run->sim_rate > 0) return (double)run->sim_rate;
    return (double)run->fps / (run->speed > 0 ? (double)run->speed : 1);
}

SectionParams schedule_greatest_params(const RunParams *run, const Section *section)
{
    SectionParams params = section->params;
    section_tracks_greatest(&section->tracks, schedule_frame_time(run, run->frames),
                            run->frames + 1, &params);
    return params;
}

Schedule schedule_create(const RunParams *run, int substeps)
{
    Schedule schedule = {.steps_per_s = substeps * schedule_period_rate(run)};
    schedule.steps_per_frame =
        nearly_whole(schedule.steps_per_s * (double)run->speed / (double)run->fps);
    schedule.settling = (int64_t)ceil((double)run->preroll * schedule.steps_per_s - WHOLE);
    return schedule;
}

ScheduledFrame schedule_frame(const Schedule *schedule, const RunParams *run, int frame)
{
    double steps = frame * schedule->steps_per_frame, whole = floor(steps + WHOLE);
    double share = steps - whole;
    return (ScheduledFrame){
        .time = schedule_frame_time(run, frame),
        .step = (int64_t)whole,
        .share = share > WHOLE ? (float)share : 0,
    };
}
