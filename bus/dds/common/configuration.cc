#include "bus/dds/common/configuration.h"

#include <fmt/format.h>

namespace ttf::bus::dds::common {

std::string loopback_configuration(std::chrono::milliseconds lease) {
  return fmt::format(R"(<CycloneDDS xmlns="https://cdds.io/config">
  <Domain Id="any">
    <General>
      <Interfaces>
        <NetworkInterface name="lo" multicast="false"/>
      </Interfaces>
      <AllowMulticast>false</AllowMulticast>
      <MaxMessageSize>65500B</MaxMessageSize>
      <FragmentSize>63000B</FragmentSize>
    </General>
    <Discovery>
      <ParticipantIndex>auto</ParticipantIndex>
      <MaxAutoParticipantIndex>{}</MaxAutoParticipantIndex>
      <Peers>
        <Peer Address="127.0.0.1"/>
      </Peers>
      <LeaseDuration>{}ms</LeaseDuration>
    </Discovery>
    <Internal>
      <SocketReceiveBufferSize max="{}B"/>
      <NackDelay>10ms</NackDelay>
      <WriterLingerDuration>0s</WriterLingerDuration>
      <Watermarks>
        <WhcHigh>{}B</WhcHigh>
        <WhcHighInit>{}B</WhcHighInit>
        <WhcAdaptive>false</WhcAdaptive>
      </Watermarks>
    </Internal>
  </Domain>
</CycloneDDS>
)",
                     kMaxParticipants - 1, lease.count(), kReceiveBufferBytes, kMaxUnacknowledgedBytes,
                     kMaxUnacknowledgedBytes);
}

}  // namespace ttf::bus::dds::common
