"""URDF files of robots that tests read."""

ARM = """<?xml version="1.0"?>
<robot name="arm">
  <!-- a turning column, a skew slide, a wrist with a tool that is fixed to it -->
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base">
    <inertial><mass value="7"/><inertia ixx="0.2" iyy="0.2" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual name="foot"><geometry><cylinder radius="0.1" length="0.05"/></geometry><material name="grey"/></visual>
  </link>
  <link name="column">
    <inertial>
      <origin xyz="0.02 -0.01 0.3" rpy="0.3 -0.2 0.7"/>
      <mass value="4"/>
      <inertia ixx="0.11" iyy="0.12" izz="0.03" ixy="0.004" ixz="-0.003" iyz="0.002"/>
    </inertial>
    <visual><origin xyz="0 0 0.3" rpy="0 1.5707963267948966 0.4"/><geometry><box size="0.1 0.1 0.6"/></geometry></visual>
    <collision><geometry><box size="0.1 0.1 0.6"/></geometry></collision>
  </link>
  <link name="slider">
    <inertial><origin xyz="0.1 0 0.05"/><mass value="1.5"/>
      <inertia ixx="0.01" iyy="0.02" izz="0.015" ixy="0.001" ixz="0" iyz="0"/></inertial>
    <visual><geometry><sphere radius="0.06"/></geometry></visual>
  </link>
  <link name="wrist">
    <inertial><origin xyz="0 0.04 0"/><mass value="0.8"/>
      <inertia ixx="0.002" iyy="0.001" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tool">
    <inertial><origin xyz="0 0 0.07" rpy="0 0.5 0"/><mass value="0.4"/>
      <inertia ixx="0.001" iyy="0.001" izz="0.0004" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://arm/meshes/tool.stl" scale="0.001 0.001 0.002"/></geometry></visual>
  </link>
  <link name="tip"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="column"/>
    <origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
    <limit effort="80" velocity="2"/>
    <dynamics damping="0.7" friction="0.4" armature="0.35"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="column"/><child link="slider"/>
    <origin xyz="0 0.1 0.5" rpy="0.2 0.3 0.1"/><axis xyz="2 0 1"/>
    <limit lower="-0.2" upper="0.4" effort="200" velocity="1"/>
    <dynamics damping="3" armature="2.5"/>
    <safety_controller k_velocity="10"/>
  </joint>
  <joint name="bend" type="revolute">
    <parent link="slider"/><child link="wrist"/>
    <origin xyz="0.2 0 0" rpy="0 0.4 1.2"/><axis xyz="0 1 0.2"/>
    <limit lower="-2" upper="2.5" effort="20" velocity="4"/>
    <dynamics damping="0.05" friction="0" armature="0.02"/>
  </joint>
  <joint name="flange" type="fixed">
    <parent link="wrist"/><child link="tool"/><origin xyz="0 0.09 0" rpy="0.6 0 0"/><axis xyz="1 0 0"/>
  </joint>
  <joint name="end" type="fixed"><parent link="tool"/><child link="tip"/><origin xyz="0 0 0.12"/></joint>
  <transmission name="drive"><type>simple</type><joint name="turn"/></transmission>
</robot>
"""

POSITIONS = {"turn": 0.4, "slide": 0.15, "bend": -0.8}
RATES = {"turn": 1.1, "slide": -0.3, "bend": 2.0}
