// SPDX-License-Identifier: MIT
// A game's loop: the host has its own OpenGL context, simulates hair in it, attached to the pose of
// a head bone, and draws it as lines from its own buffer.
//   cc game_loop.c -o game_loop $(pkg-config --cflags --libs tractrix epoxy egl) -lm
//   ./game_loop HAIR PICTURE.png
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <tractrix.h>

#include "host_context.h"

enum { WIDTH = 640, HEIGHT = 480, FRAMES = 30 };

static TractrixError error;

static void need(int good, const char *what)
{
    if (good) return;
    fprintf(stderr, "game_loop: %s\n", what);
    exit(1);
}
#define HAIR(call) need((call) == TRACTRIX_OK, error.text)

static GLuint make_program(void)
{
    static const char *const texts[] = {
        "#version 430\nlayout(location = 0) in vec4 p; out float y;\n"
        "void main() { y = p.y; gl_Position = vec4(p.x * 4.5, -p.y * 6.0, -p.z, 1.5 - p.z); }",
        "#version 430\nin float y; out vec4 color;\n"
        "void main() { color = vec4(0.75, 0.5 + y, 0.3, 1); }"};
    GLuint program = glCreateProgram();
    for (int i = 0; i < 2; ++i) {
        GLuint shader = glCreateShader(i ? GL_FRAGMENT_SHADER : GL_VERTEX_SHADER);
        glShaderSource(shader, 1, &texts[i], NULL);
        glCompileShader(shader);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    return program;
}

int main(int argc, char **argv)
{
    need(argc == 3, "expected HAIR PICTURE.png");
    need(host_context(WIDTH, HEIGHT), "no OpenGL 4.3");
    GLuint program = make_program(), color, target, buffer, array;
    glGenTextures(1, &color), glBindTexture(GL_TEXTURE_2D, color);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, WIDTH, HEIGHT);
    glGenFramebuffers(1, &target), glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);

    TractrixDevice *device;
    TractrixScene *scene;
    TractrixSimulation *simulation;
    TractrixPositions hair = {.size = sizeof hair};
    HAIR(tractrix_device_borrow(&device, &error));
    HAIR(tractrix_scene_read(&scene, argv[1], &error));
    HAIR(tractrix_simulation_create(&simulation, device, scene, &error));
    HAIR(tractrix_simulation_map(simulation, 0, TRACTRIX_GUIDES, &hair,
                                 &error)); // to get the numbers of strands and vertices
    GLint *first = malloc(hair.strand_count * sizeof *first);
    for (uint32_t s = 0, at = 0; s < hair.strand_count; at += hair.sizes[s++]) first[s] = (GLint)at;
    glGenBuffers(1, &buffer), glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 16 * (GLsizeiptr)hair.vertex_count, NULL, GL_DYNAMIC_DRAW);
    glGenVertexArrays(1, &array), glBindVertexArray(array);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, NULL), glEnableVertexAttribArray(0);
    glUseProgram(program), glViewport(0, 0, WIDTH, HEIGHT);
    glClearColor(0.1f, 0.11f, 0.13f, 1);

    for (int frame = 1; frame <= FRAMES; ++frame) {
        double angle = 0.4 * sin(frame * 0.15); // the head bone turns
        TractrixPose head = {{0, 0, sin(angle / 2), cos(angle / 2)}, {0}};
        HAIR(tractrix_simulation_advance(simulation, &head, &error));
        HAIR(tractrix_simulation_copy_to_gl(simulation, 0, TRACTRIX_GUIDES, buffer, 0, &error));
        glClear(GL_COLOR_BUFFER_BIT); // the library has restored the host's state
        glMultiDrawArrays(GL_LINE_STRIP, first, (const GLsizei *)hair.sizes,
                          (GLsizei)hair.strand_count);
    }
    static uint8_t pixels[HEIGHT][WIDTH][4]; // the shader flips the image: top row first
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    TractrixImage image = {sizeof image, WIDTH, HEIGHT, TRACTRIX_RGBA8, 0, pixels};
    HAIR(tractrix_image_write(&image, argv[2], &error));
    return 0;
}
