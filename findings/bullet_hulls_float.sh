#!/usr/bin/env bash
# Bullet's convex hulls have a margin of 4 cm around them, whatever their size: a cube that is given by its corners
# comes to rest 4 cm over the plane. btBoxShape takes its margin off its size first; btConvexHullShape does not.
#
# Expected: the lowest corner lies on the plane. Happens: 0.04 m over it, nearly the size of a cube of 0.05 m.
set -eu
packages="libbullet-dev=3.24+dfsg-2 libbullet3.24=3.24+dfsg-2"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial
apt-get install -y -qq --reinstall --download-only --no-install-recommends -o Debug::NoLocking=1 \
  -o APT::Sandbox::User=root -o Dir::Cache::Archives="$folder/archives" $packages > /dev/null
for package in archives/*.deb; do
  dpkg -x "$package" root
done
libraries="$folder/root/usr/lib/$(uname -m)-linux-gnu"
echo "$packages, $(c++ --version | head -1)"

cat > hull.cpp <<'CPP'
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdio>

// Where a cube of this side rests: its lowest corner over the plane.
double gap(double side)
{
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, -9.81));
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  plane.setMargin(0);
  btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
  world.addRigidBody(&ground);
  btConvexHullShape cube;
  for (int corner = 0; corner < 8; ++corner)
  {
    cube.addPoint(0.5 * side * btVector3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
  }
  btVector3 inertia;
  cube.calculateLocalInertia(1, inertia);
  btDefaultMotionState start(btTransform(btQuaternion::getIdentity(), btVector3(0, 0, side)));
  btRigidBody rock(btRigidBody::btRigidBodyConstructionInfo(1, &start, &cube, inertia));
  world.addRigidBody(&rock);
  for (int step = 0; step < 1200; ++step)
  {
    world.stepSimulation(1.0 / 240, 0, 1.0 / 240);
  }
  const double height = rock.getCenterOfMassPosition().z() - 0.5 * side;
  std::printf("cube of %g m: lowest corner %.4f m over the plane\n", side, height);
  world.removeRigidBody(&rock);
  world.removeRigidBody(&ground);
  return height;
}

int main()
{
  bool all = true;
  for (const double side : { 1.0, 0.1, 0.05 })
  {
    all = std::abs(gap(side) - 0.04) < 0.002 && all;
  }
  return all ? 0 : 1;
}
CPP
c++ hull.cpp -o hull -I root/usr/include/bullet -L "$libraries" -Wl,-rpath,"$libraries" \
  -lBulletDynamics -lBulletCollision -lLinearMath
./hull
