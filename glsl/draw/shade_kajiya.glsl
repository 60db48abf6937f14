// SPDX-License-Identifier: MIT
// Kajiya and Kay's fibre (SIGGRAPH 1989) with the two highlights of Scheuermann (2004), as in
// TressFX (needs material.h, lights.glsl).
//
// Light that arrives at the angle t to the fibre leaves on a cone around it. Scales on the fibre
// tilt the cone of the first reflection towards the root. Light that enters the fibre and is
// reflected inside leaves on a cone tilted towards the tip, coloured on its way.

// A local copy, because each use of a uniform costs a load.
struct Fibre {
    float ambient, diffuse, specular1, exponent1, specular2, exponent2;
    vec2 shift1, shift2; // cosine and sine
};

Fibre fibre_material()
{
    return Fibre(material.ambient, material.diffuse, material.specular1, material.exponent1,
                 material.specular2, material.exponent2,
                 vec2(material.shift1_cos, material.shift1_sin),
                 vec2(material.shift2_cos, material.shift2_sin));
}

// Linear RGB of a fibre with the colour `base` at x, with the unit tangent (root to tip) and the
// unit vector to the eye.
vec3 shade_fibre(Fibre m, vec3 base, int point, vec3 x, vec3 tangent, vec3 to_eye)
{
    float eye = clamp(dot(tangent, to_eye), -1.0, 1.0), eye_sine = fibre_sine_of(eye);
    vec3 color = m.ambient * base * light_around_fibre(tangent, to_eye, eye);
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light, reaching = light_reaching(i, x, to_light);
        float light = clamp(dot(tangent, to_light), -1.0, 1.0);
        float light_sine = fibre_sine_of(light);
        float first = fibre_highlight(light, light_sine, eye, eye_sine, m.shift1.x, m.shift1.y);
        float second = fibre_highlight(light, light_sine, eye, eye_sine, m.shift2.x, m.shift2.y);
        float white = m.specular1 * pow(first, m.exponent1);
        float tinted = m.diffuse * light_sine + m.specular2 * pow(second, m.exponent2);
        color += reaching * (white + tinted * base);
    }
    return color;
}
