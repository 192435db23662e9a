// FIBEX files written by hand in other tools' style, independent of our exporter.
#pragma once

namespace ttf::schedules::exchange::fibex {

// A small powertrain cluster in the style of public examples. Its parameters are self-consistent but
// incomplete (CYCLE and MACROTICK, no MACRO-PER-CYCLE). PDUs are ordinary, in low-high byte order, with
// codings beside the elements. One frame is in the dynamic segment, one is triggered by CYCLE-COUNTER.
inline constexpr char kPowertrain[] = R"(<?xml version="1.0" encoding="UTF-8"?>
<fx:FIBEX VERSION="3.1.0" xmlns:fx="http://www.asam.net/xml/fbx" xmlns:ho="http://www.asam.net/xml"
          xmlns:flexray="http://www.asam.net/xml/fbx/flexray" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <fx:PROJECT ID="P"><ho:SHORT-NAME>Demo</ho:SHORT-NAME></fx:PROJECT>
  <fx:ELEMENTS>
    <fx:CLUSTERS>
      <fx:CLUSTER ID="C1" xsi:type="flexray:CLUSTER-TYPE">
        <ho:SHORT-NAME>Powertrain</ho:SHORT-NAME>
        <fx:SPEED>10000000</fx:SPEED>
        <fx:BIT-COUNTING-POLICY>SAWTOOTH</fx:BIT-COUNTING-POLICY>
        <flexray:COLD-START-ATTEMPTS>8</flexray:COLD-START-ATTEMPTS>
        <flexray:ACTION-POINT-OFFSET>2</flexray:ACTION-POINT-OFFSET>
        <flexray:MINISLOT>5</flexray:MINISLOT>
        <flexray:N-I-T>6</flexray:N-I-T>
        <flexray:SAMPLE-CLOCK-PERIOD>0.012500</flexray:SAMPLE-CLOCK-PERIOD>
        <flexray:STATIC-SLOT>43</flexray:STATIC-SLOT>
        <flexray:MACROTICK>1.250000</flexray:MACROTICK>
        <flexray:MAX-INITIALIZATION-ERROR>6.6</flexray:MAX-INITIALIZATION-ERROR>
        <flexray:NUMBER-OF-MINISLOTS>210</flexray:NUMBER-OF-MINISLOTS>
        <flexray:NUMBER-OF-STATIC-SLOTS>60</flexray:NUMBER-OF-STATIC-SLOTS>
        <flexray:OFFSET-CORRECTION-START>3632</flexray:OFFSET-CORRECTION-START>
        <flexray:PAYLOAD-LENGTH-STATIC>21</flexray:PAYLOAD-LENGTH-STATIC>
        <flexray:SYNC-NODE-MAX>15</flexray:SYNC-NODE-MAX>
        <flexray:CAS-RX-LOW-MAX>99</flexray:CAS-RX-LOW-MAX>
        <flexray:CYCLE>5000</flexray:CYCLE>
      </fx:CLUSTER>
      <fx:CLUSTER ID="C2"><ho:SHORT-NAME>Body</ho:SHORT-NAME><fx:SPEED>500000</fx:SPEED></fx:CLUSTER>
    </fx:CLUSTERS>
    <fx:CHANNELS>
      <fx:CHANNEL ID="A" xsi:type="flexray:CHANNEL-TYPE">
        <ho:SHORT-NAME>FrA</ho:SHORT-NAME>
        <fx:FRAME-TRIGGERINGS>
          <fx:FRAME-TRIGGERING ID="ft1">
            <fx:TIMINGS>
              <fx:ABSOLUTELY-SCHEDULED-TIMING>
                <fx:SLOT-ID xsi:type="flexray:SLOT-ID-TYPE">13</fx:SLOT-ID>
                <fx:BASE-CYCLE xsi:type="flexray:CYCLE-COUNTER-TYPE">1</fx:BASE-CYCLE>
                <fx:CYCLE-REPETITION xsi:type="flexray:CYCLE-REPETITION-TYPE">2</fx:CYCLE-REPETITION>
              </fx:ABSOLUTELY-SCHEDULED-TIMING>
            </fx:TIMINGS>
            <fx:FRAME-REF ID-REF="frame1"/>
          </fx:FRAME-TRIGGERING>
          <fx:FRAME-TRIGGERING ID="ft2">
            <fx:TIMINGS>
              <fx:ABSOLUTELY-SCHEDULED-TIMING>
                <fx:SLOT-ID>1</fx:SLOT-ID>
                <fx:CYCLE-COUNTER>7</fx:CYCLE-COUNTER>
              </fx:ABSOLUTELY-SCHEDULED-TIMING>
            </fx:TIMINGS>
            <fx:FRAME-REF ID-REF="frame2"/>
          </fx:FRAME-TRIGGERING>
          <fx:FRAME-TRIGGERING ID="ft4">
            <fx:TIMINGS>
              <fx:ABSOLUTELY-SCHEDULED-TIMING><fx:SLOT-ID>61</fx:SLOT-ID></fx:ABSOLUTELY-SCHEDULED-TIMING>
            </fx:TIMINGS>
            <fx:FRAME-REF ID-REF="frame2"/>
          </fx:FRAME-TRIGGERING>
        </fx:FRAME-TRIGGERINGS>
        <flexray:FLEXRAY-CHANNEL-NAME>A</flexray:FLEXRAY-CHANNEL-NAME>
      </fx:CHANNEL>
      <fx:CHANNEL ID="B" xsi:type="flexray:CHANNEL-TYPE">
        <ho:SHORT-NAME>FrB</ho:SHORT-NAME>
        <fx:FRAME-TRIGGERINGS>
          <fx:FRAME-TRIGGERING ID="ft3">
            <fx:TIMINGS>
              <fx:ABSOLUTELY-SCHEDULED-TIMING>
                <fx:SLOT-ID>13</fx:SLOT-ID><fx:BASE-CYCLE>1</fx:BASE-CYCLE><fx:CYCLE-REPETITION>2</fx:CYCLE-REPETITION>
              </fx:ABSOLUTELY-SCHEDULED-TIMING>
            </fx:TIMINGS>
            <fx:FRAME-REF ID-REF="frame1"/>
          </fx:FRAME-TRIGGERING>
        </fx:FRAME-TRIGGERINGS>
        <flexray:FLEXRAY-CHANNEL-NAME>B</flexray:FLEXRAY-CHANNEL-NAME>
      </fx:CHANNEL>
    </fx:CHANNELS>
    <fx:GATEWAYS><fx:GATEWAY ID="G"/></fx:GATEWAYS>
    <fx:ECUS>
      <fx:ECU ID="E1">
        <ho:SHORT-NAME>Engine</ho:SHORT-NAME>
        <fx:CONTROLLERS>
          <fx:CONTROLLER ID="E1C" xsi:type="flexray:CONTROLLER-TYPE">
            <ho:SHORT-NAME>EngineController</ho:SHORT-NAME>
            <flexray:KEY-SLOT-USAGE><flexray:STARTUP-SYNC>1</flexray:STARTUP-SYNC></flexray:KEY-SLOT-USAGE>
            <flexray:MAX-DYNAMIC-PAYLOAD-LENGTH>127</flexray:MAX-DYNAMIC-PAYLOAD-LENGTH>
            <flexray:DECODING-CORRECTION>56</flexray:DECODING-CORRECTION>
            <flexray:EXTERN-RATE-CORRECTION>0</flexray:EXTERN-RATE-CORRECTION>
            <flexray:ALLOW-HALT-DUE-TO-CLOCK>true</flexray:ALLOW-HALT-DUE-TO-CLOCK>
            <flexray:MICROTICK>0.025</flexray:MICROTICK>
          </fx:CONTROLLER>
        </fx:CONTROLLERS>
        <fx:CONNECTORS>
          <fx:CONNECTOR ID="E1A" xsi:type="flexray:CONNECTOR-TYPE">
            <fx:CHANNEL-REF ID-REF="A"/>
            <fx:CONTROLLER-REF ID-REF="E1C"/>
            <fx:OUTPUTS>
              <fx:OUTPUT-PORT ID="o1"><fx:FRAME-TRIGGERING-REF ID-REF="ft2"/><fx:COMPLETE-FRAME/></fx:OUTPUT-PORT>
              <fx:OUTPUT-PORT ID="o2"><fx:FRAME-TRIGGERING-REF ID-REF="ft4"/><fx:COMPLETE-FRAME/></fx:OUTPUT-PORT>
            </fx:OUTPUTS>
            <flexray:WAKE-UP-CHANNEL>true</flexray:WAKE-UP-CHANNEL>
          </fx:CONNECTOR>
        </fx:CONNECTORS>
      </fx:ECU>
      <fx:ECU ID="E2">
        <ho:SHORT-NAME>ESP</ho:SHORT-NAME>
        <fx:CONNECTORS>
          <fx:CONNECTOR ID="E2A">
            <fx:INPUTS>
              <fx:INPUT-PORT ID="i1"><fx:FRAME-TRIGGERING-REF ID-REF="ft2"/></fx:INPUT-PORT>
            </fx:INPUTS>
            <fx:OUTPUTS>
              <fx:OUTPUT-PORT ID="o3"><fx:FRAME-TRIGGERING-REF ID-REF="ft1"/></fx:OUTPUT-PORT>
              <fx:OUTPUT-PORT ID="o4"><fx:FRAME-TRIGGERING-REF ID-REF="ft3"/></fx:OUTPUT-PORT>
            </fx:OUTPUTS>
          </fx:CONNECTOR>
        </fx:CONNECTORS>
      </fx:ECU>
    </fx:ECUS>
    <fx:PDUS>
      <fx:PDU ID="pdu1">
        <ho:SHORT-NAME>CrankTorque</ho:SHORT-NAME>
        <fx:BYTE-LENGTH>4</fx:BYTE-LENGTH>
        <fx:PDU-TYPE>APPLICATION</fx:PDU-TYPE>
        <fx:SIGNAL-INSTANCES>
          <fx:SIGNAL-INSTANCE ID="si2">
            <fx:BIT-POSITION>16</fx:BIT-POSITION>
            <fx:IS-HIGH-LOW-BYTE-ORDER>false</fx:IS-HIGH-LOW-BYTE-ORDER>
            <fx:SIGNAL-REF ID-REF="signal2"/>
          </fx:SIGNAL-INSTANCE>
          <fx:SIGNAL-INSTANCE ID="si1">
            <fx:BIT-POSITION>0</fx:BIT-POSITION>
            <fx:IS-HIGH-LOW-BYTE-ORDER>false</fx:IS-HIGH-LOW-BYTE-ORDER>
            <fx:SIGNAL-REF ID-REF="signal1"/>
          </fx:SIGNAL-INSTANCE>
        </fx:SIGNAL-INSTANCES>
      </fx:PDU>
      <fx:PDU ID="pdu2"><ho:SHORT-NAME>Reserve</ho:SHORT-NAME><fx:BYTE-LENGTH>2</fx:BYTE-LENGTH></fx:PDU>
    </fx:PDUS>
    <fx:FRAMES>
      <fx:FRAME ID="frame1">
        <ho:SHORT-NAME>TorqueInfo</ho:SHORT-NAME>
        <fx:BYTE-LENGTH>6</fx:BYTE-LENGTH>
        <fx:PDU-INSTANCES>
          <fx:PDU-INSTANCE ID="pi1">
            <fx:PDU-REF ID-REF="pdu1"/>
            <fx:BIT-POSITION>0</fx:BIT-POSITION>
            <fx:IS-HIGH-LOW-BYTE-ORDER>false</fx:IS-HIGH-LOW-BYTE-ORDER>
          </fx:PDU-INSTANCE>
          <fx:PDU-INSTANCE ID="pi2"><fx:PDU-REF ID-REF="pdu2"/><fx:BIT-POSITION>32</fx:BIT-POSITION></fx:PDU-INSTANCE>
        </fx:PDU-INSTANCES>
      </fx:FRAME>
      <fx:FRAME ID="frame2"><ho:SHORT-NAME>Startup</ho:SHORT-NAME><fx:BYTE-LENGTH>42</fx:BYTE-LENGTH></fx:FRAME>
    </fx:FRAMES>
    <fx:SIGNALS>
      <fx:SIGNAL ID="signal1"><ho:SHORT-NAME>TorqueReq</ho:SHORT-NAME><fx:CODING-REF ID-REF="coding1"/></fx:SIGNAL>
      <fx:SIGNAL ID="signal2"><ho:SHORT-NAME>CrankAngle</ho:SHORT-NAME><fx:CODING-REF ID-REF="coding2"/></fx:SIGNAL>
    </fx:SIGNALS>
    <fx:CODINGS>
      <fx:CODING ID="coding1">
        <ho:SHORT-NAME>Torque</ho:SHORT-NAME>
        <ho:CODED-TYPE CATEGORY="STANDARD-LENGTH-TYPE" ho:BASE-DATA-TYPE="A_UINT16"><ho:BIT-LENGTH>16</ho:BIT-LENGTH></ho:CODED-TYPE>
        <ho:COMPU-METHODS>
          <ho:COMPU-METHOD>
            <ho:SHORT-NAME>Torque</ho:SHORT-NAME>
            <ho:CATEGORY>LINEAR</ho:CATEGORY>
            <ho:UNIT-REF ID-REF="Unit_1"/>
            <ho:PHYS-CONSTRS>
              <ho:SCALE-CONSTR VALIDITY="VALID">
                <ho:LOWER-LIMIT INTERVAL-TYPE="CLOSED">0.000000</ho:LOWER-LIMIT>
                <ho:UPPER-LIMIT INTERVAL-TYPE="CLOSED">6000.000000</ho:UPPER-LIMIT>
              </ho:SCALE-CONSTR>
            </ho:PHYS-CONSTRS>
            <ho:COMPU-INTERNAL-TO-PHYS>
              <ho:COMPU-SCALES>
                <ho:COMPU-SCALE>
                  <ho:COMPU-RATIONAL-COEFFS>
                    <ho:COMPU-NUMERATOR><ho:V>-4.000000</ho:V><ho:V>1.000000</ho:V></ho:COMPU-NUMERATOR>
                    <ho:COMPU-DENOMINATOR><ho:V>8</ho:V></ho:COMPU-DENOMINATOR>
                  </ho:COMPU-RATIONAL-COEFFS>
                </ho:COMPU-SCALE>
              </ho:COMPU-SCALES>
            </ho:COMPU-INTERNAL-TO-PHYS>
          </ho:COMPU-METHOD>
        </ho:COMPU-METHODS>
      </fx:CODING>
      <fx:CODING ID="coding2">
        <ho:CODED-TYPE CATEGORY="STANDARD-LENGTH-TYPE" ho:BASE-DATA-TYPE="A_INT16"><ho:BIT-LENGTH>16</ho:BIT-LENGTH></ho:CODED-TYPE>
        <ho:COMPU-METHODS><ho:COMPU-METHOD><ho:CATEGORY>IDENTICAL</ho:CATEGORY></ho:COMPU-METHOD></ho:COMPU-METHODS>
      </fx:CODING>
    </fx:CODINGS>
    <ho:UNITS><ho:UNIT ID="Unit_1"><ho:SHORT-NAME>Nm</ho:SHORT-NAME><ho:DISPLAY-NAME>Nm</ho:DISPLAY-NAME></ho:UNIT></ho:UNITS>
  </fx:ELEMENTS>
</fx:FIBEX>
)";

// A list of objects in a foreign tool's style, multiplexed by its fragment number over two frames. It has
// other prefixes and no extension; signals within one byte are in low-high order.
inline constexpr char kObjects[] =
    R"(<f:FIBEX VERSION="3.1.0" xmlns:f="http://www.asam.net/xml/fbx" xmlns="http://www.asam.net/xml"
         xmlns:flexray="http://www.asam.net/xml/fbx/flexray" xmlns:i="http://www.w3.org/2001/XMLSchema-instance">
  <f:ELEMENTS>
    <f:CLUSTERS><f:CLUSTER ID="C" i:type="flexray:CLUSTER-TYPE">
      <SHORT-NAME>Objects</SHORT-NAME><f:SPEED>5000000</f:SPEED>
      <flexray:STATIC-SLOT>100</flexray:STATIC-SLOT><flexray:MACRO-PER-CYCLE>5000</flexray:MACRO-PER-CYCLE>
      <flexray:MACROTICK>2</flexray:MACROTICK><flexray:NUMBER-OF-STATIC-SLOTS>45</flexray:NUMBER-OF-STATIC-SLOTS>
      <flexray:PAYLOAD-LENGTH-STATIC>8</flexray:PAYLOAD-LENGTH-STATIC>
    </f:CLUSTER></f:CLUSTERS>
    <f:CHANNELS><f:CHANNEL ID="A" i:type="flexray:CHANNEL-TYPE">
      <f:FRAME-TRIGGERINGS>
        <f:FRAME-TRIGGERING ID="t2"><f:TIMINGS><f:ABSOLUTELY-SCHEDULED-TIMING><f:SLOT-ID>9</f:SLOT-ID></f:ABSOLUTELY-SCHEDULED-TIMING></f:TIMINGS><f:FRAME-REF ID-REF="second"/></f:FRAME-TRIGGERING>
        <f:FRAME-TRIGGERING ID="t1"><f:TIMINGS><f:ABSOLUTELY-SCHEDULED-TIMING><f:SLOT-ID>8</f:SLOT-ID></f:ABSOLUTELY-SCHEDULED-TIMING></f:TIMINGS><f:FRAME-REF ID-REF="first"/></f:FRAME-TRIGGERING>
      </f:FRAME-TRIGGERINGS>
      <flexray:FLEXRAY-CHANNEL-NAME>A</flexray:FLEXRAY-CHANNEL-NAME>
    </f:CHANNEL></f:CHANNELS>
    <f:ECUS><f:ECU ID="E"><SHORT-NAME>Radar</SHORT-NAME><f:CONNECTORS><f:CONNECTOR ID="k"><f:OUTPUTS>
      <f:OUTPUT-PORT ID="p1"><f:FRAME-TRIGGERING-REF ID-REF="t1"/></f:OUTPUT-PORT>
      <f:OUTPUT-PORT ID="p2"><f:FRAME-TRIGGERING-REF ID-REF="t2"/></f:OUTPUT-PORT>
    </f:OUTPUTS></f:CONNECTOR></f:CONNECTORS></f:ECU></f:ECUS>
    <f:PDUS>
      <f:PDU ID="list"><SHORT-NAME>objects</SHORT-NAME><f:BYTE-LENGTH>8</f:BYTE-LENGTH>
        <f:MULTIPLEXER>
          <f:SWITCH ID="s"><SHORT-NAME>fragment</SHORT-NAME><f:BIT-POSITION>3</f:BIT-POSITION>
            <f:IS-HIGH-LOW-BYTE-ORDER>false</f:IS-HIGH-LOW-BYTE-ORDER><BIT-LENGTH>1</BIT-LENGTH></f:SWITCH>
          <f:DYNAMIC-PART ID="d"><SHORT-NAME>d</SHORT-NAME>
            <f:SEGMENT-POSITIONS><f:SEGMENT-POSITION><f:BIT-POSITION>15</f:BIT-POSITION>
              <f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER><BIT-LENGTH>56</BIT-LENGTH></f:SEGMENT-POSITION></f:SEGMENT-POSITIONS>
            <f:SWITCHED-PDU-INSTANCES>
              <f:SWITCHED-PDU-INSTANCE ID="w1"><f:PDU-REF ID-REF="part"/><f:SWITCH-CODE>1</f:SWITCH-CODE></f:SWITCHED-PDU-INSTANCE>
              <f:SWITCHED-PDU-INSTANCE ID="w0"><f:PDU-REF ID-REF="part"/><f:SWITCH-CODE>0</f:SWITCH-CODE></f:SWITCHED-PDU-INSTANCE>
            </f:SWITCHED-PDU-INSTANCES>
          </f:DYNAMIC-PART>
          <f:STATIC-PART ID="x"><SHORT-NAME>x</SHORT-NAME>
            <f:SEGMENT-POSITIONS><f:SEGMENT-POSITION><f:BIT-POSITION>0</f:BIT-POSITION><BIT-LENGTH>8</BIT-LENGTH></f:SEGMENT-POSITION></f:SEGMENT-POSITIONS>
            <f:STATIC-PDU-INSTANCE ID="y"><f:PDU-REF ID-REF="head"/></f:STATIC-PDU-INSTANCE>
          </f:STATIC-PART>
        </f:MULTIPLEXER>
      </f:PDU>
      <f:PDU ID="head"><SHORT-NAME>head</SHORT-NAME><f:BYTE-LENGTH>1</f:BYTE-LENGTH><f:SIGNAL-INSTANCES>
        <f:SIGNAL-INSTANCE ID="a"><f:BIT-POSITION>4</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>false</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="sq"/></f:SIGNAL-INSTANCE>
        <f:SIGNAL-INSTANCE ID="b"><f:BIT-POSITION>3</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>false</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="fr"/></f:SIGNAL-INSTANCE>
        <f:SIGNAL-INSTANCE ID="c"><f:BIT-POSITION>2</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="ct"/></f:SIGNAL-INSTANCE>
      </f:SIGNAL-INSTANCES></f:PDU>
      <f:PDU ID="part"><SHORT-NAME>part</SHORT-NAME><f:BYTE-LENGTH>7</f:BYTE-LENGTH><f:SIGNAL-INSTANCES>
        <f:SIGNAL-INSTANCE ID="d0"><f:BIT-POSITION>7</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="x0"/></f:SIGNAL-INSTANCE>
        <f:SIGNAL-INSTANCE ID="d1"><f:BIT-POSITION>11</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="v0"/></f:SIGNAL-INSTANCE>
        <f:SIGNAL-INSTANCE ID="d2"><f:BIT-POSITION>17</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="x1"/></f:SIGNAL-INSTANCE>
        <f:SIGNAL-INSTANCE ID="d3"><f:BIT-POSITION>37</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER><f:SIGNAL-REF ID-REF="v1"/></f:SIGNAL-INSTANCE>
      </f:SIGNAL-INSTANCES></f:PDU>
    </f:PDUS>
    <f:FRAMES>
      <f:FRAME ID="first"><SHORT-NAME>Objects1</SHORT-NAME><f:BYTE-LENGTH>8</f:BYTE-LENGTH><f:PDU-INSTANCES><f:PDU-INSTANCE ID="q"><f:PDU-REF ID-REF="list"/><f:BIT-POSITION>7</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER></f:PDU-INSTANCE></f:PDU-INSTANCES></f:FRAME>
      <f:FRAME ID="second"><SHORT-NAME>Objects2</SHORT-NAME><f:BYTE-LENGTH>8</f:BYTE-LENGTH><f:PDU-INSTANCES><f:PDU-INSTANCE ID="r"><f:PDU-REF ID-REF="list"/><f:BIT-POSITION>7</f:BIT-POSITION><f:IS-HIGH-LOW-BYTE-ORDER>true</f:IS-HIGH-LOW-BYTE-ORDER></f:PDU-INSTANCE></f:PDU-INSTANCES></f:FRAME>
    </f:FRAMES>
    <f:SIGNALS>
      <f:SIGNAL ID="sq"><SHORT-NAME>sequence</SHORT-NAME><f:CODING-REF ID-REF="u4"/></f:SIGNAL>
      <f:SIGNAL ID="fr"><SHORT-NAME>fragment</SHORT-NAME><f:CODING-REF ID-REF="u1"/></f:SIGNAL>
      <f:SIGNAL ID="ct"><SHORT-NAME>count</SHORT-NAME><f:CODING-REF ID-REF="u3"/></f:SIGNAL>
      <f:SIGNAL ID="x0"><SHORT-NAME>x_0</SHORT-NAME><f:CODING-REF ID-REF="metres"/></f:SIGNAL>
      <f:SIGNAL ID="v0"><SHORT-NAME>v_0</SHORT-NAME><f:CODING-REF ID-REF="u10"/></f:SIGNAL>
      <f:SIGNAL ID="x1"><SHORT-NAME>x_1</SHORT-NAME><f:CODING-REF ID-REF="metres"/></f:SIGNAL>
      <f:SIGNAL ID="v1"><SHORT-NAME>v_1</SHORT-NAME><f:CODING-REF ID-REF="u10"/></f:SIGNAL>
    </f:SIGNALS>
  </f:ELEMENTS>
  <f:PROCESSING-INFORMATION>
    <UNIT-SPEC><UNITS><UNIT ID="m"><SHORT-NAME>metre</SHORT-NAME><DISPLAY-NAME>m</DISPLAY-NAME></UNIT></UNITS></UNIT-SPEC>
    <f:CODINGS>
      <f:CODING ID="u1"><CODED-TYPE BASE-DATA-TYPE="A_UINT8"><BIT-LENGTH>1</BIT-LENGTH></CODED-TYPE></f:CODING>
      <f:CODING ID="u3"><CODED-TYPE BASE-DATA-TYPE="A_UINT8"><BIT-LENGTH>3</BIT-LENGTH></CODED-TYPE></f:CODING>
      <f:CODING ID="u4"><CODED-TYPE BASE-DATA-TYPE="A_UINT8"><BIT-LENGTH>4</BIT-LENGTH></CODED-TYPE></f:CODING>
      <f:CODING ID="u10"><CODED-TYPE BASE-DATA-TYPE="A_UINT16"><BIT-LENGTH>10</BIT-LENGTH></CODED-TYPE></f:CODING>
      <f:CODING ID="metres"><CODED-TYPE BASE-DATA-TYPE="A_UINT16"><BIT-LENGTH>12</BIT-LENGTH></CODED-TYPE>
        <COMPU-METHODS><COMPU-METHOD><CATEGORY>LINEAR</CATEGORY><UNIT-REF ID-REF="m"/><COMPU-INTERNAL-TO-PHYS><COMPU-SCALES><COMPU-SCALE>
          <COMPU-RATIONAL-COEFFS><COMPU-NUMERATOR><V>-100</V><V>0.05</V></COMPU-NUMERATOR></COMPU-RATIONAL-COEFFS>
        </COMPU-SCALE></COMPU-SCALES></COMPU-INTERNAL-TO-PHYS></COMPU-METHOD></COMPU-METHODS></f:CODING>
    </f:CODINGS>
  </f:PROCESSING-INFORMATION>
</f:FIBEX>
)";

}  // namespace ttf::schedules::exchange::fibex
