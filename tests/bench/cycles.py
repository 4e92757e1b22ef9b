"""The peers' scene in Cycles, written against the Python API of Blender 3.4.

    blender -b --factory-startup -P tests/bench/cycles.py -- \
        --environment config/environments/forest.exr --out FOLDER \
        --material A0,alpha,sigma_s,sigma_a,samples [--material ...] \
        [--seed 1 --seed 2] [--size 256] [--threads 0] [--multiple] \
        [--mesh FILE.obj] [--camera x,y,z]

writes FOLDER/NAME-SEED.exr (linear, 32-bit float) for each and FOLDER/cycles.json with the CPU
seconds of each render, less what every render pays once.
`speed --cycles` runs it and sets the figures beside ours.
"""

import argparse
import json
import math
import os
import resource
import sys

import bpy
from mathutils import Matrix, Vector

RED = (0.15, 1.0, 1.0)  # absorption per channel, relative
IOR = 1.5
BOUNCES = 1024  # the most that Cycles takes


def arguments():
    own = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="cycles.py")
    parser.add_argument("--environment", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--material", action="append", required=True,
                        help="name,alpha,sigma_s,sigma_a,samples")
    parser.add_argument("--seed", action="append", type=int)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--threads", type=int, default=0, help="0: all")
    parser.add_argument("--multiple", action="store_true",
                        help="multiple scattering between microfacets")
    parser.add_argument("--mesh", help="OBJ of triangles, flat; instead of the unit sphere")
    parser.add_argument("--camera", default="0,0,4.5", help="its position")
    return parser.parse_args(own)


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy.context.scene


def add_world(scene, environment):
    """The environment as OpenEXR has it: +z is the middle of the map, its left towards +x, +y up.

    Cycles looks up u = 0.5 - atan2(y, x) / (2 pi), v from +z: turned as to_blender turns the scene,
    the map lies the same way.
    """
    world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    image = bpy.data.images.load(os.path.abspath(environment))
    image.colorspace_settings.name = "Linear"
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    texture.projection = "EQUIRECTANGULAR"
    texture.interpolation = "Linear"
    background = nodes.new("ShaderNodeBackground")
    output = nodes.new("ShaderNodeOutputWorld")
    links.new(texture.outputs["Color"], background.inputs["Color"])
    links.new(background.outputs["Background"], output.inputs["Surface"])
    scene.world = world


def to_blender(x, y, z):
    return Vector((z, x, y))


def add_camera(scene, position):
    """A pinhole that looks at the origin, +y up, 32 degrees."""
    data = bpy.data.cameras.new("camera")
    data.type = "PERSP"
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(32)
    data.clip_start, data.clip_end = 0.01, 1000
    camera = bpy.data.objects.new("camera", data)
    place = to_blender(*position)
    back = place.normalized()
    right = to_blender(0, 1, 0).cross(back).normalized()
    up = back.cross(right)
    camera.matrix_world = Matrix.Translation(place) @ Matrix(
        (right, up, back)).transposed().to_4x4()
    scene.collection.objects.link(camera)
    scene.camera = camera


def add_sphere(scene):
    """A unit sphere of 327,680 triangles with the normals of the sphere."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=8, radius=1)
    sphere = bpy.context.object
    bpy.ops.object.shade_smooth()
    return sphere


def add_mesh(scene, file):
    vertices, faces = [], []
    with open(file) as lines:
        for line in lines:
            kind, *rest = line.split()
            if kind == "v":
                vertices.append(to_blender(*map(float, rest)))
            elif kind == "f":
                faces.append([int(i) - 1 for i in rest])
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(vertices, [], faces)
    body = bpy.data.objects.new("mesh", mesh)
    scene.collection.objects.link(body)
    return body


def body_material(name, alpha, sigma_s, sigma_a, multiple):
    """Glass, and behind it scatterers and absorbers in 1 / length."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    glass = nodes.new("ShaderNodeBsdfGlass")
    glass.inputs["Color"].default_value = (1, 1, 1, 1)
    glass.inputs["IOR"].default_value = IOR
    glass.inputs["Roughness"].default_value = math.sqrt(alpha)  # Cycles squares it
    glass.distribution = "SHARP" if alpha == 0 else "MULTI_GGX" if multiple else "GGX"
    links.new(glass.outputs["BSDF"], output.inputs["Surface"])
    volumes = []
    if sigma_s > 0:  # density x color
        scatter = nodes.new("ShaderNodeVolumeScatter")
        scatter.inputs["Color"].default_value = (1, 1, 1, 1)
        scatter.inputs["Density"].default_value = sigma_s
        scatter.inputs["Anisotropy"].default_value = 0
        volumes.append(scatter)
    if sigma_a > 0:  # density x (1 - color)
        absorb = nodes.new("ShaderNodeVolumeAbsorption")
        absorb.inputs["Color"].default_value = (*(1 - red for red in RED), 1)
        absorb.inputs["Density"].default_value = sigma_a
        volumes.append(absorb)
    if len(volumes) == 2:
        both = nodes.new("ShaderNodeAddShader")
        for i, volume in enumerate(volumes):
            links.new(volume.outputs["Volume"], both.inputs[i])
        links.new(both.outputs["Shader"], output.inputs["Volume"])
    elif volumes:
        links.new(volumes[0].outputs["Volume"], output.inputs["Volume"])
    material.cycles.homogeneous_volume = True
    return material


def settle(scene, size, threads):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    scene.render.use_persistent_data = False
    scene.render.threads_mode = "FIXED" if threads else "AUTO"
    if threads:
        scene.render.threads = threads
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
    image.exr_codec = "ZIP"
    scene.view_settings.view_transform = "Raw"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.time_limit = 0
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.light_sampling_threshold = 0
    cycles.max_bounces = BOUNCES
    for kind in ("diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, kind + "_bounces", BOUNCES)


def main():
    options = arguments()
    os.makedirs(options.out, exist_ok=True)
    renders = []
    for description in options.material:
        name, *numbers = description.split(",")
        alpha, sigma_s, sigma_a = map(float, numbers[:3])
        samples = int(numbers[3])
        scene = empty_scene()
        settle(scene, options.size, options.threads)
        add_world(scene, options.environment)
        add_camera(scene, [float(x) for x in options.camera.split(",")])
        body = add_mesh(scene, options.mesh) if options.mesh else add_sphere(scene)
        body.data.materials.append(
            body_material(name, alpha, sigma_s, sigma_a, options.multiple))

        def render(count, seed, file):
            scene.cycles.samples, scene.cycles.seed = count, seed
            scene.render.filepath = file
            start = cpu_seconds()
            bpy.ops.render.render(write_still=True)
            return cpu_seconds() - start

        # What every render pays once - the mesh, its tree, the file - is that of a single sample
        # less that sample.
        one = render(1, 0, os.path.join(options.out, "warm.exr"))
        few = max(2, samples // 4)
        some = render(few, 0, os.path.join(options.out, "warm.exr"))
        overhead = max(0.0, one - (some - one) / (few - 1))
        for seed in options.seed or [1, 2]:
            file = os.path.abspath(os.path.join(options.out, f"{name}-{seed}.exr"))
            seconds = render(samples, seed, file) - overhead
            renders.append({"material": name, "seed": seed, "samples": samples,
                            "cpu_seconds": seconds, "file": file})
    with open(os.path.join(options.out, "cycles.json"), "w") as out:
        json.dump({"version": bpy.app.version_string, "renders": renders}, out, indent=1)


if __name__ == "__main__":
    try:
        main()
    except Exception as error:  # Blender would go on and exit with 0
        import traceback
        traceback.print_exc()
        sys.exit(1)
