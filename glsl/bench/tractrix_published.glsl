// SPDX-License-Identifier: MIT
// The tractrix step as published in the thesis, to compare it with ours: the recipe of Sreenivasan,
// Goel and Ghosal (Mechanism and Machine Theory 45, 2010) in the plane of the move, with the
// thesis's own guards. Nothing else uses it.
//
// x runs along the move from the old head, y across it towards the tail. The tail's distance y to
// the line gives the parameter p = L asech(y/L). A towed tail ends at x = s - L tanh((p + s)/L), y
// = L sech((p + s)/L). A pushed tail has p - s, and x = s + L tanh((p - s)/L). As published,
// "towed" means that the tail is farther from the head's target than from the head, which is wrong
// for a pushed tail that the head passes (s > 2 a L); p + s is limited to 100 metres, whatever the
// scale; a tail that would move farther than the head moves by s towards the head, in segments (not
// metres); a move along the segment translates it.

float published_asech(float u) { return log((1.0 + sqrt(1.0 - u * u)) / u); }

vec3 tractrix_published(vec3 h, vec3 t, vec3 p)
{
    vec3 S = p - h, T = t - h, z = cross(S, T);
    float s = length(S), L = length(T);
    if (z == vec3(0.0)) return t + S;
    vec3 across = cross(normalize(z), S / s);
    float start = L * published_asech(dot(across, T) / L);
    bool towed = length(t - p) > length(t - h);
    float q = towed ? clamp(start + s, -100.0, 100.0) : start - s;
    float x = towed ? s - L * tanh(q / L) : s + L * tanh(q / L), y = L / cosh(q / L);
    vec3 tail = h + x * (S / s) + y * across;
    return length(tail - t) < s ? tail : t + (h - t) * s;
}
