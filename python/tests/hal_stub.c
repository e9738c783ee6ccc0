/* What kinematics modules of LinuxCNC ask of HAL and RTAPI, so that a test can call their laws without LinuxCNC running.
   Pins are kept by name; the real library is in LinuxCNC's own process. */

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PINS = 256, NAME = 64 };

static char names[PINS][NAME];
static double values[PINS];
static double *places[PINS];
static int pins;

/* A name and where its value is: `at`, or a place of our own if that is NULL. */
static void *keep(const char *name, double *at)
{
    if (pins == PINS)
        abort();
    snprintf(names[pins], NAME, "%s", name);
    places[pins] = at ? at : &values[pins];
    return places[pins++];
}

static void *pin(const char *name) { return keep(name, NULL); }

/* The value of a pin or parameter of type float, NULL if the module has none of that name; the newest, where a module has
   been started again. */
double *stub_pin(const char *name)
{
    for (int each = pins - 1; each >= 0; each--)
        if (strcmp(names[each], name) == 0)
            return places[each];
    return NULL;
}

int hal_init(const char *name) { (void)name; return 1; }
int hal_ready(int component) { (void)component; return 0; }
int hal_exit(int component) { (void)component; return 0; }
void *hal_malloc(long size) { return calloc(1, (size_t)size + 64); }

int hal_pin_float_new(const char *name, int direction, double **to, int component)
{
    (void)direction; (void)component;
    *to = pin(name);
    return 0;
}

int hal_pin_float_newf(int direction, double **to, int component, const char *format, ...)
{
    char name[NAME];
    va_list arguments;
    (void)direction; (void)component;
    va_start(arguments, format);
    vsnprintf(name, NAME, format, arguments);
    va_end(arguments);
    *to = pin(name);
    return 0;
}

int hal_pin_bit_new(const char *name, int direction, void **to, int component)
{
    (void)direction; (void)component;
    *to = pin(name);
    return 0;
}

int hal_pin_s32_new(const char *name, int direction, void **to, int component)
{
    (void)direction; (void)component;
    *to = pin(name);
    return 0;
}

int hal_pin_u32_newf(int direction, void **to, int component, const char *format, ...)
{
    char name[NAME];
    va_list arguments;
    (void)direction; (void)component;
    va_start(arguments, format);
    vsnprintf(name, NAME, format, arguments);
    va_end(arguments);
    *to = pin(name);
    return 0;
}

/* A parameter is in the module's own memory. */
int hal_param_float_newf(int direction, double *at, int component, const char *format, ...)
{
    char name[NAME];
    va_list arguments;
    (void)direction; (void)component;
    va_start(arguments, format);
    vsnprintf(name, NAME, format, arguments);
    va_end(arguments);
    keep(name, at);
    return 0;
}

int hal_set_unready(int component) { (void)component; return 0; }

int hal_pin_s32_newf(int direction, void **to, int component, const char *format, ...)
{
    (void)direction; (void)component;
    *to = pin(format);
    return 0;
}

int rtapi_snprintf(char *to, unsigned long size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int written = vsnprintf(to, size, format, arguments);
    va_end(arguments);
    return written;
}

int hal_pin_bit_newf(int direction, void **to, int component, const char *format, ...)
{
    (void)direction; (void)component;
    *to = pin(format);
    return 0;
}

void rtapi_print(const char *format, ...) { (void)format; }
void rtapi_print_msg(int level, const char *format, ...) { (void)level; (void)format; }
