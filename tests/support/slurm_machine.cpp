#include "tests/support/slurm_machine.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

namespace fw::test {

namespace {

/// One that is free now.
int freePort() {
    const int socketOf = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(socketOf, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(socketOf, reinterpret_cast<sockaddr*>(&address), &size), 0);
    close(socketOf);
    return ntohs(address.sin_port);
}

std::string key() {
    std::random_device random;
    std::string text;
    for (int i = 0; i < 128; ++i) text += char(random());
    return text;
}

std::string hostName() {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return std::string(name).substr(0, std::string(name).find('.'));
}

}  // namespace

bool comesTrue(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;
}

std::string SlurmMachine::whyNot() {
    if (geteuid() != 0) return "Slurm's daemons need root";
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch"})
        if (runProgram(std::string("PATH=$PATH:/usr/sbin command -v ") + program).status != 0)
            return std::string(program) + " is not installed";
    return {};
}

SlurmMachine::SlurmMachine() {
    std::filesystem::permissions(folder.folder, std::filesystem::perms(0755));
    writeText(folder.path("munge.key"), key());
    std::filesystem::permissions(folder.path("munge.key"), std::filesystem::perms(0400));
    const std::string socketPath = folder.path("munge.socket"), host = hostName();
    start({"munged", "--foreground", "--force", "--socket=" + socketPath,
           "--key-file=" + folder.path("munge.key"), "--pid-file=" + folder.path("munged.pid"),
           "--log-file=" + folder.path("munged.log"), "--seed-file=" + folder.path("munge.seed")});
    std::filesystem::create_directory(folder.path("state"));
    std::filesystem::create_directory(folder.path("spool"));
    writeText(
        folder.path("slurm.conf"),
        "ClusterName=test\nSlurmctldHost=" + host +
            "(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\nAuthType=auth/munge\nAuthInfo=socket=" +
            socketPath + "\nSlurmctldPort=" + std::to_string(freePort()) + "\nSlurmdPort=" +
            std::to_string(freePort()) + "\nSlurmctldPidFile=" + folder.path("slurmctld.pid") +
            "\nSlurmdPidFile=" + folder.path("slurmd.pid") + "\nStateSaveLocation=" + folder.path("state") +
            "\nSlurmdSpoolDir=" + folder.path("spool") +
            "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\n"
            "MpiDefault=none\nSelectType=select/cons_tres\nReturnToService=2\nNodeName=" +
            host +
            " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\nPartitionName=all Nodes=ALL Default=YES State=UP\n");
    EXPECT_TRUE(comesTrue([&] { return std::filesystem::exists(socketPath); }));
    start({"slurmctld", "-D", "-c"});
    start({"slurmd", "-D", "-c"});
    const auto idle = [&] { return run("sinfo --noheader --format=%T").output == "idle\n"; };
    EXPECT_TRUE(comesTrue(idle)) << readText(folder.path("slurmctld.said"))
                                 << readText(folder.path("slurmd.said"));
}

SlurmMachine::~SlurmMachine() {
    for (auto daemon = daemons.rbegin(); daemon != daemons.rend(); ++daemon) {
        kill(*daemon, SIGTERM);
        waitpid(*daemon, nullptr, 0);
    }
}

void SlurmMachine::start(const std::vector<std::string>& words) {
    const std::string said = folder.path(words.front() + ".said"), configuration = folder.path("slurm.conf");
    const pid_t child = fork();
    if (child == 0) {
        setenv("SLURM_CONF", configuration.c_str(), 1);
        setenv("PATH", (std::string(getenv("PATH")) + ":/usr/sbin").c_str(), 1);
        const int out = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(out, 1), dup2(out, 2);
        std::vector<char*> list;
        for (const std::string& word : words) list.push_back(const_cast<char*>(word.c_str()));
        list.push_back(nullptr);
        execvp(list[0], list.data());
        _exit(127);
    }
    daemons.push_back(child);
}

ProgramResult SlurmMachine::run(const std::string& commandLine) const {
    return runProgram(environment() + " " + commandLine);
}

void SlurmMachine::waitForAll() const {
    EXPECT_TRUE(comesTrue([&] { return run("squeue --noheader").output.empty(); })) << run("squeue").output;
}

}  // namespace fw::test
