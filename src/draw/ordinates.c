// SPDX-License-Identifier: MIT
#include "draw/ordinates.h"

#include "glsl/kernel/cell.h"

#include <math.h>
#include <pthread.h>

const float ORDINATE[3][ORDINATES] = {
    {-0.722086f, -0.933447f, -0.729081f, -0.929400f, -0.934657f, -0.718108f, -0.930610f, -0.725103f,
     0.720357f,  0.932498f,  0.728274f,  0.929079f,  0.934978f,  0.718915f,  0.931559f,  0.726832f,
     0.298844f,  -0.621819f, -0.296843f, -0.111714f, 0.623819f,  -0.342546f, 0.345124f,  0.114291f,
     -0.119881f, -0.343250f, 0.340672f,  -0.628575f, 0.117304f,  0.286687f,  0.626574f,  -0.288688f,
     0.297784f,  -0.619721f, -0.108700f, -0.335162f, 0.350315f,  0.123846f,  0.631481f,  -0.286020f,
     -0.299512f, 0.107749f,  0.618912f,  -0.350634f, 0.335481f,  -0.630672f, -0.122895f, 0.287747f},
    {0.620322f,  0.343337f,  0.299310f,  0.110083f,  -0.112865f, -0.301469f, -0.346119f,
     -0.622482f, 0.630386f,  0.342975f,  0.284538f,  0.122156f,  -0.119374f, -0.282379f,
     -0.340193f, -0.628226f, -0.731765f, -0.728360f, -0.715724f, -0.936573f, -0.718574f,
     -0.931128f, -0.933227f, -0.926917f, 0.936228f,  0.930105f,  0.934250f,  0.726494f,
     0.927263f,  0.732638f,  0.720440f,  0.714850f,  0.615385f,  0.281823f,  0.331101f,
     -0.128433f, 0.103195f,  -0.356327f, -0.301411f, -0.634980f, 0.634106f,  0.356673f,
     0.303277f,  0.127409f,  -0.102171f, -0.283689f, -0.331446f, -0.614511f},
    {-0.306254f, 0.103910f,  0.615512f,  -0.352275f, 0.337162f,  -0.627245f, -0.119023f, 0.294521f,
     0.289309f,  -0.113209f, -0.623422f, 0.349128f,  -0.334015f, 0.635156f,  0.128322f,  -0.277575f,
     -0.612546f, -0.287807f, 0.632158f,  -0.332191f, 0.307411f,  0.125148f,  -0.099888f, 0.357439f,
     0.330313f,  -0.130708f, 0.105448f,  0.277670f,  -0.355561f, 0.617294f,  -0.297274f, -0.636905f,
     -0.729812f, -0.732476f, -0.937313f, -0.933366f, -0.930930f, -0.926117f, -0.714411f, -0.717630f,
     0.712883f,  0.927995f,  0.724549f,  0.927805f,  0.936490f,  0.722339f,  0.935436f,  0.734559f},
};

float TANGENT[TANGENTS][3];
float TANGENT_SINE[TANGENTS][ORDINATES];

static void make_tangent(int class)
{
    double z = 1 - 2 * (class + 0.5) / TANGENTS, across = sqrt(1 - z * z),
           turn = PI * (1 + sqrt(5)) * (class + 0.5);
    float *t = TANGENT[class];
    t[0] = (float)(across * cos(turn));
    t[1] = (float)(across * sin(turn));
    t[2] = (float)z;
    for (int d = 0; d < ORDINATES; ++d) {
        float along = t[0] * ORDINATE[0][d] + t[1] * ORDINATE[1][d] + t[2] * ORDINATE[2][d];
        TANGENT_SINE[class][d] = sqrtf(fmaxf(1 - along * along, 0));
    }
}

// --- Look-up of the nearest ordinate, by squares on the faces of a cube.

enum { SQUARES = ORDINATE_SQUARES };
uint8_t TANGENT_NEAREST[6][SQUARES][SQUARES];

static int find_nearest(const float way[3])
{
    int best = 0;
    float most = -2;
    for (int class = 0; class < TANGENTS; ++class) {
        const float *t = TANGENT[class];
        float cosine = t[0] * way[0] + t[1] * way[1] + t[2] * way[2];
        if (cosine > most) most = cosine, best = class;
    }
    return best;
}

static void prepare(void)
{
    for (int class = 0; class < TANGENTS; ++class) make_tangent(class);
    for (int face = 0; face < 6; ++face)
        for (int j = 0; j < SQUARES; ++j)
            for (int i = 0; i < SQUARES; ++i) {
                float at[2] = {2 * ((float)i + 0.5f) / SQUARES - 1,
                               2 * ((float)j + 0.5f) / SQUARES - 1};
                float length = sqrtf(1 + at[0] * at[0] + at[1] * at[1]), way[3];
                way[face / 2] = (face % 2 ? 1.f : -1.f) / length;
                way[(face / 2 + 1) % 3] = at[0] / length;
                way[(face / 2 + 2) % 3] = at[1] / length;
                TANGENT_NEAREST[face][j][i] = (uint8_t)find_nearest(way);
            }
}

void ordinates_prepare(void)
{
    static pthread_once_t prepared = PTHREAD_ONCE_INIT;
    pthread_once(&prepared, prepare);
}

int ordinates_class(const float t[3])
{
    float x = fabsf(t[0]), y = fabsf(t[1]), z = fabsf(t[2]);
    int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    float main = fmaxf(fabsf(t[axis]), 1e-20f);
    return TANGENT_NEAREST[2 * axis + (t[axis] > 0)][cell_square(t[(axis + 2) % 3] / main, SQUARES)]
                          [cell_square(t[(axis + 1) % 3] / main, SQUARES)];
}
