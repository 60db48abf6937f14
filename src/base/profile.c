// SPDX-License-Identifier: MIT
#include "base/profile.h"

#include "base/decimal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

float profile_at(float mean, const Profile *along, double share)
{
    if (!along->count) return mean;
    uint32_t i = 0;
    while (i < along->count && (double)along->at[i] < share) ++i;
    if (i == 0) return along->value[0];
    if (i == along->count) return along->value[i - 1];
    double from = (double)along->at[i - 1], to = (double)along->at[i],
           t = (share - from) / (to - from);
    return (float)((1 - t) * (double)along->value[i - 1] + t * (double)along->value[i]);
}

static float mean_of(const Profile *along)
{
    uint32_t last = along->count - 1;
    double sum = (double)along->at[0] * (double)along->value[0] +
                 (1 - (double)along->at[last]) * (double)along->value[last];
    for (uint32_t i = 0; i < last; ++i)
        sum += 0.5 * ((double)along->at[i + 1] - (double)along->at[i]) *
               ((double)along->value[i] + (double)along->value[i + 1]);
    return (float)sum;
}

// Parses a decimal number; strtod alone would also accept hexadecimal numbers, infinity and NaN.
static bool read_number(const char **at, double *number)
{
    const char *text = *at + strspn(*at, " \t");
    size_t length = strspn(text, "0123456789+-.eE");
    char *end = NULL;
    *number = strtod(text, &end);
    if (end == text || end > text + length) return false;
    *at = end + strspn(end, " \t");
    return true;
}

// Reads the points. A point without a place gets the place -1.
static bool read_points(Profile *along, const char *at, double minimum, double maximum)
{
    for (;;) {
        double value = 0, place = -1;
        if (along->count == PROFILE_MOST || !read_number(&at, &value)) return false;
        if (!(value >= minimum && value <= maximum)) return false;
        if (*at == '@') {
            ++at;
            if (!read_number(&at, &place) || !(place >= 0 && place <= 1)) return false;
        }
        along->at[along->count] = (float)place;
        along->value[along->count++] = (float)value;
        if (!*at) return true;
        if (*at++ != ':') return false;
    }
}

// Fills in the missing places; false if the places do not ascend.
static bool place_points(Profile *along)
{
    uint32_t last = along->count - 1;
    bool any = false;
    for (uint32_t i = 0; i <= last; ++i) any |= along->at[i] >= 0;
    for (uint32_t i = 0; i <= last; ++i)
        if (along->at[i] < 0 && (!any || i == 0 || i == last))
            along->at[i] = (float)((double)i / (double)last);
    for (uint32_t i = 0; i < last; ++i)
        if (along->at[i] < 0 || !(along->at[i] < along->at[i + 1])) return false;
    return true;
}

bool profile_parse(ProfileNumber *number, const char *text, double minimum, double maximum)
{
    Profile along = {0};
    if (!read_points(&along, text, minimum, maximum)) return false;
    if (along.count == 1) {
        if (along.at[0] >= 0) return false;
        *number = (ProfileNumber){.mean = along.value[0]};
        return true;
    }
    if (!place_points(&along)) return false;
    *number = (ProfileNumber){mean_of(&along), along};
    return true;
}

void profile_format(const ProfileNumber *number, char *text, size_t size)
{
    const Profile *along = &number->along;
    if (!along->count) {
        decimal_format(number->mean, text, size);
        return;
    }
    size_t length = 0;
    *text = 0;
    for (uint32_t i = 0; i < along->count && length < size; ++i) {
        char value[32], place[32];
        bool plain = (i == 0 && along->at[i] == 0) || (i + 1 == along->count && along->at[i] == 1);
        decimal_format(along->value[i], value, sizeof value);
        decimal_format(along->at[i], place, sizeof place);
        length += (size_t)snprintf(text + length, size - length, "%s%s%s%s", i ? ":" : "", value,
                                   plain ? "" : "@", plain ? "" : place);
    }
}
